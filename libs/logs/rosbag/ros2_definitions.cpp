// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/ros2_definitions.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace psi_slam {
namespace {

struct Definition {
  std::string_view type;
  std::string_view members;  ///< one a line; types of other messages with their package
};

constexpr std::array kDefinitions{
    Definition{"builtin_interfaces/Time",
               "int32 sec\n"
               "uint32 nanosec\n"},
    Definition{"std_msgs/Header",
               "builtin_interfaces/Time stamp\n"
               "string frame_id\n"},
    Definition{"geometry_msgs/Point",
               "float64 x\n"
               "float64 y\n"
               "float64 z\n"},
    Definition{"geometry_msgs/Vector3",
               "float64 x\n"
               "float64 y\n"
               "float64 z\n"},
    Definition{"geometry_msgs/Quaternion",
               "float64 x\n"
               "float64 y\n"
               "float64 z\n"
               "float64 w\n"},
    Definition{"geometry_msgs/Pose",
               "geometry_msgs/Point position\n"
               "geometry_msgs/Quaternion orientation\n"},
    Definition{"geometry_msgs/PoseWithCovariance",
               "geometry_msgs/Pose pose\n"
               "float64[36] covariance\n"},
    Definition{"geometry_msgs/Twist",
               "geometry_msgs/Vector3 linear\n"
               "geometry_msgs/Vector3 angular\n"},
    Definition{"geometry_msgs/TwistWithCovariance",
               "geometry_msgs/Twist twist\n"
               "float64[36] covariance\n"},
    Definition{"geometry_msgs/Transform",
               "geometry_msgs/Vector3 translation\n"
               "geometry_msgs/Quaternion rotation\n"},
    Definition{"geometry_msgs/TransformStamped",
               "std_msgs/Header header\n"
               "string child_frame_id\n"
               "geometry_msgs/Transform transform\n"},
    Definition{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    Definition{"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
    Definition{"nav_msgs/Odometry",
               "std_msgs/Header header\n"
               "string child_frame_id\n"
               "geometry_msgs/PoseWithCovariance pose\n"
               "geometry_msgs/TwistWithCovariance twist\n"},
    Definition{"sensor_msgs/LaserScan",
               "std_msgs/Header header\n"
               "float32 angle_min\n"
               "float32 angle_max\n"
               "float32 angle_increment\n"
               "float32 time_increment\n"
               "float32 scan_time\n"
               "float32 range_min\n"
               "float32 range_max\n"
               "float32[] ranges\n"
               "float32[] intensities\n"},
    Definition{"sensor_msgs/LaserEcho", "float32[] echoes\n"},
    Definition{"sensor_msgs/MultiEchoLaserScan",
               "std_msgs/Header header\n"
               "float32 angle_min\n"
               "float32 angle_max\n"
               "float32 angle_increment\n"
               "float32 time_increment\n"
               "float32 scan_time\n"
               "float32 range_min\n"
               "float32 range_max\n"
               "sensor_msgs/LaserEcho[] ranges\n"
               "sensor_msgs/LaserEcho[] intensities\n"},
    Definition{"sensor_msgs/Imu",
               "std_msgs/Header header\n"
               "geometry_msgs/Quaternion orientation\n"
               "float64[9] orientation_covariance\n"
               "geometry_msgs/Vector3 angular_velocity\n"
               "float64[9] angular_velocity_covariance\n"
               "geometry_msgs/Vector3 linear_acceleration\n"
               "float64[9] linear_acceleration_covariance\n"},
    Definition{"sensor_msgs/PointField",
               "string name\n"
               "uint32 offset\n"
               "uint8 datatype\n"
               "uint32 count\n"},
    Definition{"sensor_msgs/PointCloud2",
               "std_msgs/Header header\n"
               "uint32 height\n"
               "uint32 width\n"
               "sensor_msgs/PointField[] fields\n"
               "bool is_bigendian\n"
               "uint32 point_step\n"
               "uint32 row_step\n"
               "uint8[] data\n"
               "bool is_dense\n"},
};

std::string_view members_of(std::string_view type) {
  const auto* const found = std::find_if(kDefinitions.begin(), kDefinitions.end(),
                                         [&](const Definition& one) { return one.type == type; });
  return found == kDefinitions.end() ? std::string_view() : found->members;
}

/// Appends the message types of members to a list, those that it does not contain yet.
void add_types_of(std::string_view members, std::vector<std::string_view>& types) {
  while (!members.empty()) {
    const std::string_view type = members.substr(0, members.find_first_of(" ["));
    const bool is_message = type.find('/') != std::string_view::npos;
    if (is_message && std::find(types.begin(), types.end(), type) == types.end()) types.push_back(type);
    members.remove_prefix(members.find('\n') + 1);
  }
}

}  // namespace

std::string ros2_definition(std::string_view type) {
  constexpr std::size_t kSeparatorBytes = 80;
  std::string text;
  std::vector<std::string_view> types{type};
  for (std::size_t i = 0; i < types.size(); ++i) {
    const std::string_view members = members_of(types[i]);
    if (i > 0) text.append(kSeparatorBytes, '=').append("\nMSG: ").append(types[i]).append("\n");
    text += members;
    add_types_of(members, types);
  }
  return text;
}

}  // namespace psi_slam
