// SPDX-License-Identifier: BSD-3-Clause
// psi-slam-gui: a window in which a log is replayed and the map is seen being made.
//
//     psi-slam-gui [LOG] [-c INI] [--set SECTION.KEY=VALUE]...
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace psi_slam {

class MainFrame;

/// Runs the program with its arguments (without its own name) until its window is closed. Returns the exit
/// code: 0 done, 1 failed (there is no display), 2 wrong usage or input; wrong arguments are told before any
/// window opens. `when_shown` is called from the event loop once the window is there: for tests that drive
/// it.
int run_gui(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
            const std::function<void(MainFrame&)>& when_shown = {});

}  // namespace psi_slam
