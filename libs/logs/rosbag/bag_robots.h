// SPDX-License-Identifier: BSD-3-Clause
// Robots of a bag that recorded several: which topics and frames belong to the same robot.
#pragma once

#include <string>
#include <vector>

#include "logs/rosbag/bag_file.h"
#include "logs/rosbag/transform_tree.h"

namespace psi_slam {

/// Robots by the namespaces of their topics. A namespace is the first part of a topic that has several parts.
/// It belongs to a robot if it has scans, and odometry or transforms. Topics without a namespace form a robot
/// under the same condition.
class BagRobots {
 public:
  explicit BagRobots(const std::vector<BagTopic>& topics);

  bool are_several() const { return names_.size() > 1; }

  /// Returns whether a topic belongs to the robot that scans on `scan_topic`, or is shared by all robots.
  bool may_share(const std::string& topic, const std::string& scan_topic) const;

  /// Returns the topics that the robot of a topic of scans may use. Omits topics without a namespace, such
  /// as /tf, if they belong to another robot and this robot has such topics in its own namespace.
  std::vector<std::string> of_robot(const std::vector<std::string>& topics,
                                    const std::string& scan_topic) const;

  /// Returns whether a topic has the namespace of a robot.
  bool has_robot(const std::string& topic) const;

  /// Name of the robot of a topic: its namespace; empty for topics that no namespace assigns to a robot.
  std::string robot_of(const std::string& topic) const;

 private:
  std::vector<std::string> names_;
};

/// Returns whether a topic or frame is named like odometry.
bool is_named_like_odometry(std::string frame);

/// Returns the robot's frame if odometry does not state it: the topmost frame whose name contains "base"
/// above the first of the lasers' frames that has one. Otherwise the nearest frame above all lasers, such as
/// the frame of a single laser. Empty without a laser.
std::string base_frame_by_name(const TransformTree& transforms, const std::vector<std::string>& laser_frames);

/// Returns whether two frames are parts of one robot: transforms connect them below all frames that are named
/// like odometry, a map or the world.
bool are_on_one_robot(const TransformTree& transforms, const std::string& a, const std::string& b);

}  // namespace psi_slam
