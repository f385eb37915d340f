// SPDX-License-Identifier: BSD-3-Clause
// psi-graphslam: MRPT's graphslam-engine with the deciders of MRPT and of psi-slam.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace psi_slam {

/// Runs the program with its arguments, without the program's name. Returns the exit code: 0 done, also if
/// the user interrupted it; 1 failed; 2 wrong usage or input, also if the log is damaged. During mapping, the
/// first SIGINT or SIGTERM ends the mapping or the final loop search, and the map is written. The second
/// signal ends the process. MRPT's engine prints its own messages to the process' standard output.
int run_graphslam_app(const std::vector<std::string>& arguments, std::ostream& out,
                      std::ostream& err) noexcept;

}  // namespace psi_slam
