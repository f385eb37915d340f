// SPDX-License-Identifier: BSD-3-Clause
// A log as MRPT's own programs read it: a rawlog of actions and sensory frames, which each of them accepts.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "psi_slam/time_stamp.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Writes every frame: how odometry moved since the one before, then the scan with its beams and its laser's
/// mount. The first has not moved, and odometry's noise is what MRPT assumes where nobody says. Returns the
/// frames' times, in their order. `stop` is asked before each; once true, throws SystemFailure, as when the
/// file cannot be written. Throws UserError as the source does.
std::vector<TimeUs> write_baseline_log(FrameSource& source, const std::filesystem::path& path,
                                    const std::function<bool()>& stop);

}  // namespace psi_slam
