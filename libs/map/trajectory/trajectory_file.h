// SPDX-License-Identifier: BSD-3-Clause
// Trajectories, and their text files in the formats that evo and the tools of the Freiburg benchmark read.
// Lengths are in metres, angles in radians, time stamps in seconds.
//
//     TUM       timestamp tx ty tz qx qy qz qw      with tz = qx = qy = 0, qz = sin(yaw/2), qw = cos(yaw/2)
//     plane     timestamp x y theta
//     CSV       time_s,x_m,y_m,theta_rad,...        as in trajectory.csv of psi-slam, after a line of names
//     CARMEN    FLASER n r1..rn  x y theta  odom_x odom_y odom_theta  timestamp host logger_timestamp
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// A pose at one time, usually the pose of the robot in the map.
struct StampedPose {
  TimeUs time_us = 0;
  mrpt::math::TPose2D pose;
};

/// Poses in the order of the log. Their times may decrease.
using Trajectory = std::vector<StampedPose>;

/// Returns the trajectory in TUM format: no header, one line per pose, in the order given.
std::string tum_text(const Trajectory& trajectory);

/// Writes the text of tum_text() atomically. Throws SystemFailure if the file cannot be written.
void write_tum(const std::filesystem::path& path, const Trajectory& trajectory);

/// Reads a file in any of the four formats above. The first line that is not a comment decides whether the
/// file is a CARMEN log or a CSV table, of which further columns are ignored; the number of words tells the
/// other formats apart. '#' starts a comment. Projects TUM poses onto the plane. Takes the first pose of each
/// FLASER line of a CARMEN log and ignores its other messages. Throws UserError ("file:line: expected ...")
/// for a malformed line, and if the file has no pose.
Trajectory read_trajectory(const std::filesystem::path& path);

struct PoseAtTime {
  mrpt::math::TPose2D pose;
  bool interpolated = false;
  std::size_t from = 0;  ///< index of the pose taken, or of the earlier of the two poses interpolated
};

/// Returns the trajectory's pose less than 0.1 ms from `time_us` if there is one. Otherwise interpolates
/// linearly between the poses before and after `time_us`, the angle along the shorter arc. `sorted` is sorted
/// by time. Returns nothing outside the trajectory's span of time and in gaps longer than `max_gap_us`.
std::optional<PoseAtTime> pose_at_time(const Trajectory& sorted, TimeUs time_us, TimeUs max_gap_us);

}  // namespace psi_slam
