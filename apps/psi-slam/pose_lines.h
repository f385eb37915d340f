// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Form of a line with the pose of a scan.
enum class PoseFormat {
  kTum,  ///< "time x y z qx qy qz qw": seconds, metres, quaternion
  /// {"time_s": s, "x_m": m, "y_m": m, "yaw_rad": rad, "frame": number, "matched": true}, and "covariance" if
  /// it is known: 36 numbers in the order of ROS, row by row of (x, y, z, roll, pitch, yaw)
  kJson,
};

/// Pose of the robot in the map at one scan, as it is known when the scan was mapped.
struct LivePose {
  TimeUs time_us = 0;
  mrpt::math::TPose2D map_T_robot;
  std::size_t frame = 0;  ///< number of the scan, from 0
  bool matched = false;   ///< whether the scan was matched with the map; false: the pose is a prediction
  /// Covariance of (x, y, yaw) in the axes of the map: m^2, m rad, rad^2.
  std::optional<Eigen::Matrix3d> covariance{};
};

/// Returns the line, with its line end.
std::string pose_line(const LivePose& pose, PoseFormat format);

}  // namespace psi_slam
