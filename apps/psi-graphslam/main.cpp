// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <iostream>

#include "graphslam_app.h"

int main(int argc, char** argv) {
  // A file that reaches the limit of `ulimit -f` gives an error message, as on a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  return psi_slam::run_graphslam_app({argv + 1, argv + argc}, std::cout, std::cerr);
}
