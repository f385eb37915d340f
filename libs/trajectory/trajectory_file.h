// SPDX-License-Identifier: BSD-3-Clause
// Trajectories as text, readable by evo and the benchmark's tools. Lengths are metres, angles radians, stamps
// seconds.
//
//     TUM       timestamp tx ty tz qx qy qz qw      with tz = qx = qy = 0, qz = sin(yaw/2), qw = cos(yaw/2)
//     plane     timestamp x y theta
//     CARMEN    FLASER n r1..rn  x y theta  odom_x odom_y odom_theta  timestamp host logger_timestamp
//
// The order of a trajectory is its log's order, which need not be the order of time.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <filesystem>
#include <string>
#include <vector>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Where something (usually the robot, in the map) was at one time.
struct StampedPose {
  TimeUs time_us = 0;
  mrpt::math::TPose2D pose;
};

using Trajectory = std::vector<StampedPose>;

/// The trajectory in TUM's format, one pose a line in the order given; no header, so that every reader takes
/// it.
std::string tum_text(const Trajectory& trajectory);

/// Writes `tum_text` atomically. Throws SystemFailure when it cannot be written.
void write_tum(const std::filesystem::path& path, const Trajectory& trajectory);

/// Reads any of the three formats above; the first line that is no comment tells which. In TUM files
/// everything out of the plane is dropped; of a CARMEN log the first pose of each FLASER line is taken and
/// all other messages are passed over. Comments start with '#'. Throws UserError (file:line, what was
/// expected) on a malformed line, and when there is no pose in the file.
Trajectory read_trajectory(const std::filesystem::path& path);

}  // namespace psi_slam
