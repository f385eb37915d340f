// SPDX-License-Identifier: BSD-3-Clause
#include "carmen/carmen_message.h"

namespace psi_slam {
namespace {

std::vector<float> read_ranges(CarmenFields& fields) {
  const std::size_t readings = fields.count("the number of readings");
  if (readings == 0) fields.fail("the scan has 0 readings, expected 1 or more");
  return fields.ranges(readings);
}

/// type start_angle fov resolution max_range accuracy remission_mode  n r1..rn  m rem1..remm
CarmenLaserMessage read_configuration_and_ranges(CarmenFields& fields) {
  CarmenLaserMessage message;
  fields.number("the laser's type");
  message.start_angle_rad = fields.number("start_angle");
  message.field_of_view_rad = fields.number("field_of_view");
  message.resolution_rad = fields.number("angular_resolution");
  message.max_range_m = fields.number("maximum_range");
  fields.number("accuracy");
  fields.number("remission_mode");
  message.ranges_m = read_ranges(fields);
  fields.skip_numbers(fields.count("the number of remissions"), "remission");
  return message;
}

}  // namespace

CarmenLaserMessage read_flaser(CarmenFields& fields) {
  CarmenLaserMessage message;
  message.ranges_m = read_ranges(fields);
  message.odom_T_laser = fields.pose("the pose");
  message.odom_T_robot = fields.pose("the odometry pose");
  message.time_us = fields.stamps();
  return message;
}

CarmenLaserMessage read_rawlaser(CarmenFields& fields) {
  CarmenLaserMessage message = read_configuration_and_ranges(fields);
  message.time_us = fields.stamps();
  return message;
}

CarmenLaserMessage read_robotlaser(CarmenFields& fields) {
  CarmenLaserMessage message = read_configuration_and_ranges(fields);
  message.odom_T_laser = fields.pose("the laser pose");
  message.odom_T_robot = fields.pose("the robot pose");
  for (const char* what : {"tv", "rv", "forward_safety_dist", "side_safety_dist", "turn_axis"})
    fields.number(what);
  message.time_us = fields.stamps();
  return message;
}

CarmenOdometryMessage read_odometry(CarmenFields& fields) {
  CarmenOdometryMessage message;
  message.odom_T_robot = fields.pose("the odometry pose");
  for (const char* what : {"tv", "rv", "acceleration"}) fields.number(what);
  message.time_us = fields.stamps();
  return message;
}

}  // namespace psi_slam
