// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace psi_slam {

/// Returns the definition of a message type that psi-slam records, followed by those of the types of its
/// members, in the format "ros2msg" of MCAP (https://mcap.dev/spec/registry#ros2msg). `type` is a ROS 1 name:
/// "sensor_msgs/LaserScan". Returns an empty text for any other type.
std::string ros2_definition(std::string_view type);

}  // namespace psi_slam
