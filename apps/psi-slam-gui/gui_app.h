// SPDX-License-Identifier: BSD-3-Clause
// psi-slam-gui: replays a log in a window and shows how the map is built.
//
//     psi-slam-gui [LOG [--edits FILE]] [-c INI] [--set SECTION.KEY=VALUE]...
//     psi-slam-gui --tcp PORT | --follow LOG | --sensors INI [-c INI] [--set SECTION.KEY=VALUE]...
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace psi_slam {

class MainFrame;

/// Runs the program until its window is closed. `arguments` do not include the program's name. Returns the
/// exit code: 0 success, 1 failure (such as no display), 2 wrong usage or input. Wrong arguments are reported
/// before a window opens. Tests use `when_shown`, which the event loop calls once the window is shown.
int run_gui(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
            const std::function<void(MainFrame&)>& when_shown = {});

}  // namespace psi_slam
