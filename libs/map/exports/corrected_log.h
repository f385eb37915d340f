// SPDX-License-Identifier: BSD-3-Clause
// The corrected log: the input log in CARMEN's text format with the mapped pose of each scan, as the tools of
// the Freiburg benchmark read it.
//
//     FLASER n r1..rn  x y theta  odom_x odom_y odom_theta  timestamp host logger_timestamp
//
// Both poses are the robot's: first in the map, then raw odometry. A beam without return is written as the
// sensor's maximum range, an invalid reading as 0. Scan lines cannot hold bearings and mount. PARAM lines at
// the top state the mount and the beam spacing, and a comment states the bearings. Ranges are always
// counter-clockwise, so log.mirrored must not be set for this file. RLASER lines hold the scans of a second
// laser, with the poses at their own time. CARMEN has no message with poses for a third laser, so the scans
// of further lasers are left out, and so are scans whose ranges were discarded.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Writes the scans of `log` in their order, atomically. Each scan gets the pose of the same index in
/// `map_T_robot`. With `run`, writes only that run: between runs odometry jumps and times decrease, which
/// readers of CARMEN logs do not expect. Throws std::invalid_argument if the counts differ, SystemFailure if
/// the file cannot be written.
void write_corrected_log(const std::filesystem::path& path, const std::vector<Frame>& log,
                         const std::vector<mrpt::math::TPose2D>& map_T_robot,
                         const std::optional<FrameSpan>& run = std::nullopt);

}  // namespace psi_slam
