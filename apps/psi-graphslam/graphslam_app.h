// SPDX-License-Identifier: BSD-3-Clause
// psi-graphslam: MRPT's graph-slam engine with its deciders and ours, as its graphslam-engine has it.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace psi_slam {

/// Runs the program with the arguments behind its name. Returns its exit code: 0 done, also when the user
/// interrupted it; 1 failed; 2 wrong usage or input, also when the log breaks off. While it maps, SIGINT and
/// SIGTERM end the mapping or its last pass in good order, and a second one the process. MRPT's engine prints
/// its own messages to the process' standard output.
int run_graphslam_app(const std::vector<std::string>& arguments, std::ostream& out,
                      std::ostream& err) noexcept;

}  // namespace psi_slam
