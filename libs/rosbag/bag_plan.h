// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rosbag/bag_file.h"
#include "psi_slam/log_options.h"
#include "rosbag/transform_tree.h"

namespace psi_slam {

/// What of a ROS bag is read.
struct BagPlan {
  std::vector<std::string> scan_topics;  ///< by the numbers of the lasers (LaserScan::laser)
  std::string odometry_topic;  ///< empty: odometry is the transform from odom_frame to base_frame
  std::vector<std::string> transform_topics;
  std::string odom_frame;
  std::string base_frame;    ///< the robot's: that which odometry moves
  TransformTree transforms;  ///< as far as they were needed to find the frames

  /// All topics to read.
  std::vector<std::string> topics() const;
};

/// What is wrong with odometry that has no pose.
std::string no_pose_text(const std::string& topic);

/// The poses of robots in bags come from a topic of their own or from a transform.
bool is_transforms(const BagTopic& topic);

/// The options for the laser of a topic, with its stated mount.
LogOptions options_of_topic(const LogOptions& options, const std::string& topic);

/// Finds the topics by their types, or by name where the user names them, and the frames by reading on until
/// all are known. Throws UserError when something is missing, or there are several and none is named.
BagPlan plan_bag(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
