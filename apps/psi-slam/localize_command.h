// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"
#include "session/settings.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// psi-slam localize. Returns the exit code: 0 where the robot was localized at any time, 1 where never, 2
/// where the log breaks off. Throws UserError when map, log or start are no such thing.
int localize(const CommandLine& line, const Settings& settings, const Streams& streams);

}  // namespace psi_slam
