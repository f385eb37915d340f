// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <string>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Form of a line with the pose of a scan.
enum class PoseFormat {
  kTum,   ///< "time x y z qx qy qz qw": seconds, metres, quaternion
  kJson,  ///< {"time": s, "x": m, "y": m, "yaw": rad, "frame": number, "matched": true}
};

/// Pose of the robot in the map at one scan, as it is known when the scan was mapped.
struct LivePose {
  TimeUs time_us = 0;
  mrpt::math::TPose2D map_T_robot;
  std::size_t frame = 0;  ///< number of the scan, from 0
  bool matched = false;   ///< whether the scan was matched with the map; false: the pose is a prediction
};

/// Returns the line, with its line end.
std::string pose_line(const LivePose& pose, PoseFormat format);

}  // namespace psi_slam
