// SPDX-License-Identifier: BSD-3-Clause
// The corrected log: the log itself in CARMEN's text format with the mapped pose of every scan, as the tools
// of the Freiburg benchmark read it.
//
//     FLASER n r1..rn  x y theta  odom_x odom_y odom_theta  timestamp host logger_timestamp
//
// Both poses are the robot's: the first in the map, the second raw odometry. A beam that returned nothing is
// written as the sensor's maximum. FLASER has no room for the beams' bearings and the laser's mount: PARAM
// lines at the top say the mount, and the bearings as far as CARMEN has names for them; a comment says them
// whole. Ranges go counter-clockwise, also those of a laser that runs clockwise: who reads this log must not
// set log.mirrored again. The second laser of a robot has RLASER lines, each with the poses of its own time;
// CARMEN has no lines with poses for a third.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <filesystem>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Writes every scan of `log`, in its order, with the pose of the same index in `map_T_robot`; atomically.
/// Throws std::invalid_argument when their counts differ, SystemFailure when it cannot be written.
void write_corrected_log(const std::filesystem::path& path, const std::vector<Frame>& log,
                         const std::vector<mrpt::math::TPose2D>& map_T_robot);
/// Writes the scans of one drive alone. Of several drives odometry jumps and stamps run back from one to the
/// next, which readers of CARMEN logs do not expect.
void write_corrected_log(const std::filesystem::path& path, const std::vector<Frame>& log,
                         const std::vector<mrpt::math::TPose2D>& map_T_robot, const FrameSpan& drive);

}  // namespace psi_slam
