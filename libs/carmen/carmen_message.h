// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "psi_slam/time_stamp.h"
#include "carmen/carmen_fields.h"

namespace psi_slam {

/// One message of a laser as the line has it: nothing is filtered, and what its kind does not carry is left
/// at zero.
struct CarmenLaserMessage {
  TimeUs time_us = 0;  ///< ipc_timestamp
  std::vector<float> ranges_m;
  double start_angle_rad = 0;        ///< bearing of the first reading
  double field_of_view_rad = 0;      ///< 0: not stated
  double resolution_rad = 0;         ///< step between readings; 0: not stated
  double max_range_m = 0;            ///< 0: not stated
  mrpt::math::TPose2D odom_T_laser;  ///< of a corrected log: a mapper's result, not odometry
  mrpt::math::TPose2D odom_T_robot;
};

struct CarmenOdometryMessage {
  TimeUs time_us = 0;
  mrpt::math::TPose2D odom_T_robot;
};

// Each takes the fields behind the message's name, and throws MalformedLine on another.
CarmenLaserMessage read_flaser(CarmenFields& fields);      ///< also RLASER
CarmenLaserMessage read_rawlaser(CarmenFields& fields);    ///< without poses
CarmenLaserMessage read_robotlaser(CarmenFields& fields);  ///< the robot's pose is odometry
CarmenOdometryMessage read_odometry(CarmenFields& fields);

}  // namespace psi_slam
