// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "psi_slam/log_options.h"
#include "rosbag/bag_file.h"
#include "rosbag/transform_tree.h"

namespace psi_slam {

/// Topics and frames of a ROS bag that are read.
struct BagPlan {
  std::vector<std::string> scan_topics;  ///< ordered by LaserScan::laser
  std::string odometry_topic;            ///< empty: odometry is the transform from odom_frame to base_frame
  std::vector<std::string> transform_topics;
  std::string odom_frame;
  std::string base_frame;    ///< the robot's frame, which odometry moves
  TransformTree transforms;  ///< those that were needed to find the frames

  /// Names of all topics to read.
  std::vector<std::string> topics() const;
};

/// Message about odometry with an invalid pose.
std::string invalid_pose_text(const std::string& topic);

/// Returns whether the messages of the topic are transforms.
bool is_transforms(const BagTopic& topic);

/// Options for the laser of a topic, with its stated mount.
LogOptions options_of_topic(const LogOptions& options, const std::string& topic);

/// Finds the topics by their types, or by the names that the user states. Then reads until all frames are
/// known. Throws UserError if something is missing, or if several topics match and the user names none.
BagPlan plan_bag(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
