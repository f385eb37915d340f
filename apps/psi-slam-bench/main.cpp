// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <iostream>

#include "bench_app.h"

int main(int argc, char** argv) {
  return psi_slam::run_bench_app({argv + 1, argv + argc},
                                 {std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1});
}
