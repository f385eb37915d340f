// SPDX-License-Identifier: BSD-3-Clause
// psi-slam: from a log to a map.
//
//     psi-slam [-c INI] [--set SECTION.KEY=VALUE]... LOG -o DIR     maps a log
//     psi-slam --resume SESSION [LOG] -o DIR                        goes on with a run that was saved
//     psi-slam check [-c INI] LOG                                   tells what a log holds, and what is wrong
//     psi-slam localize MAP LOG [-o DIR] [--start X,Y,YAW_DEG]      finds a robot in a finished map
//     psi-slam merge A B... -o DIR [--start X,Y,YAW_DEG]            maps several drives as one
//     psi-slam options [--markdown]                                 explains every option
//     psi-slam sweep LOG... -o DIR [--set SECTION.KEY=V,V]...       maps many logs with many settings
//     psi-slam --dump-config [-c INI] [--set ...]                   prints a settings file
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace psi_slam {

/// Where a program's words go.
struct Streams {
  std::ostream& out;             ///< results
  std::ostream& err;             ///< progress and complaints
  bool err_is_terminal = false;  ///< then progress is shown
};

/// Runs the program with its arguments (without its own name). Returns the exit code: 0 done, also when the
/// user interrupted it; 1 failed, or not localized at the end; 2 wrong usage or input. Never throws. While it
/// maps, SIGINT and SIGTERM end the mapping or its last pass in good order, and a second one the process.
int run_psi_slam_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept;

}  // namespace psi_slam
