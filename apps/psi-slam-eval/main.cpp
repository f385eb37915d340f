// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <iostream>

#include "eval_app.h"

int main(int argc, char** argv) {
  // Ignores SIGXFSZ, so that a write beyond `ulimit -f` fails instead of ending the program.
  std::signal(SIGXFSZ, SIG_IGN);
  return psi_slam::run_eval_app({argv + 1, argv + argc}, std::cout, std::cerr);
}
