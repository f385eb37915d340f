// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "eval_app.h"

int main(int argc, char** argv) {
  return psi_slam::run_eval_app({argv + 1, argv + argc}, std::cout, std::cerr);
}
