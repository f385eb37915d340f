// SPDX-License-Identifier: BSD-3-Clause
// Parses the ROS messages that psi-slam needs, from the bytes of ROS 1 (packed, little endian) and of ROS 2
// (CDR of either byte order, numbers aligned to their size).
#pragma once

#include <mrpt/math/TPoint3D.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <optional>
#include <string>
#include <vector>

#include "logs/rosbag/bag_file.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

inline constexpr const char* kRosLaserScan = "sensor_msgs/LaserScan";
inline constexpr const char* kRosMultiEchoScan = "sensor_msgs/MultiEchoLaserScan";
inline constexpr const char* kRosPointCloud = "sensor_msgs/PointCloud2";
inline constexpr const char* kRosImu = "sensor_msgs/Imu";
inline constexpr const char* kRosOdometry = "nav_msgs/Odometry";
inline constexpr const char* kRosTransforms = "tf2_msgs/TFMessage";
inline constexpr const char* kRosOldTransforms = "tf/tfMessage";  ///< older type with the same bytes

struct RosHeader {
  TimeUs time_us = 0;
  std::string frame;  ///< without the leading slash that old programs write
};

struct RosLaserScan {
  RosHeader header;
  float angle_min_rad = 0;
  float angle_increment_rad = 0;
  float time_increment_s = 0;  ///< time between neighbouring beams; 0 if not stated
  float scan_time_s = 0;       ///< time between scans; 0 if not stated
  float range_min_m = 0;
  float range_max_m = 0;
  std::vector<float> ranges_m;
};

/// Pose of `child_frame` in the frame of the header, from an odometry message or a transform.
struct RosTransform {
  RosHeader header;
  std::string child_frame;
  mrpt::poses::CPose3D pose;
};

struct RosImu {
  RosHeader header;
  /// Angular velocity along the axes of the header's frame, radians per second. Empty if the message states
  /// that it has none.
  std::optional<mrpt::math::TVector3D> rate_radps;
};

struct RosPointCloud {
  RosHeader header;
  std::vector<mrpt::math::TPoint3Df> points;  ///< metres in the header's frame; may be NaN
};

// Each function throws MalformedBytes if the message is shorter than it states or has an unknown encoding.
/// Reads a scan of either type. Of several echoes of a beam, reads the first; a beam without echo has NaN.
RosLaserScan read_ros_laser_scan(const BagMessage& message);

/// Reads the points of a cloud, row by row. Throws MalformedBytes also if the fields x, y or z are missing or
/// have another type than float32 or float64.
RosPointCloud read_ros_point_cloud(const BagMessage& message);

RosImu read_ros_imu(const BagMessage& message);

/// Returns the header of any message that begins with one, such as a scan, a cloud or an IMU's message.
RosHeader read_ros_header(const BagMessage& message);

/// Returns the pose of the robot in the odometry's frame. Empty if the pose is invalid: not finite, or a
/// quaternion whose length is not 1.
std::optional<RosTransform> read_ros_odometry(const BagMessage& message);

/// Returns x, y and yaw of a pose. The yaw is rounded to 10^-12 radians, because the last bits of a yaw that
/// was a quaternion are arbitrary. So a log keeps its odometry when it is played.
mrpt::math::TPose2D on_floor(const mrpt::poses::CPose3D& pose);

/// Returns the time of a rosgraph_msgs/Clock.
TimeUs read_ros_clock(const BagMessage& message);
/// Returns the text of a std_msgs/String.
std::string read_ros_string(const BagMessage& message);
/// Returns x, y and yaw of a geometry_msgs/PoseWithCovarianceStamped. Empty if it is invalid, as in
/// read_ros_odometry().
std::optional<mrpt::math::TPose2D> read_ros_pose(const BagMessage& message);

/// Error message for odometry with an invalid pose, without the place.
std::string invalid_pose_text(const std::string& topic);

/// Returns the transforms of a message. Skips invalid transforms, because most transforms are not needed.
std::vector<RosTransform> read_ros_transforms(const BagMessage& message);

}  // namespace psi_slam
