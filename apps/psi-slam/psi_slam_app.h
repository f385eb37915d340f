// SPDX-License-Identifier: BSD-3-Clause
// psi-slam: makes a map from a log, and localizes robots in it.
//
//     psi-slam [-c INI] [--set SECTION.KEY=VALUE]... LOG -o DIR     maps a log
//     psi-slam --resume SESSION [LOG] -o DIR                        resumes a saved run
//     psi-slam check [-c INI] LOG                                   shows what a log holds and what is wrong
//     psi-slam localize MAP LOG [-o DIR] [--start X,Y,YAW_DEG]      finds a robot in a finished map
//     psi-slam live --stdin|--tcp PORT|--follow LOG|--sensors INI -o DIR   maps while the robot drives
//     psi-slam merge A B... -o DIR [--start X,Y,YAW_DEG]            makes one map of several runs
//     psi-slam options [--markdown]                                 explains every option
//     psi-slam sweep LOG... -o DIR [--set SECTION.KEY=V,V]...       maps many logs with many settings
//     psi-slam --dump-config [-c INI] [--set ...]                   prints a settings file
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace psi_slam {

/// Output of a program.
struct Streams {
  std::ostream& out;             ///< results
  std::ostream& err;             ///< progress, warnings and errors
  bool err_is_terminal = false;  ///< progress is shown only on a terminal
};

/// Runs the program with its arguments, without the program's name. Returns the exit code: 0 done, also after
/// an interrupted mapping; 1 failed, merge or sweep not completed, or not localized at the end; 2 wrong usage
/// or input. Of diff: 0 no wall has changed, 1 a wall has changed, 2 any error. During mapping, the first
/// SIGINT or SIGTERM ends the mapping or the final loop search, and the map is written. The second signal
/// ends the process.
int run_psi_slam_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept;

}  // namespace psi_slam
