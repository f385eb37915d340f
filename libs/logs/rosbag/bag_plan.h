// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "logs/rosbag/bag_file.h"
#include "logs/rosbag/bag_topics.h"
#include "logs/rosbag/transform_tree.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// The topics and frames to read from a ROS bag.
struct BagPlan {
  std::vector<std::string> scan_topics;  ///< index: LaserScan::laser
  /// Topics of one laser each, of which scan_topics has the first: those whose mounts the user states, then
  /// those with short names.
  std::vector<std::vector<std::string>> rival_topics;
  bool has_odometry = false;   ///< false: scans have no odometry
  std::string odometry_topic;  ///< empty: odometry is the transform from odom_frame to base_frame
  std::string imu_topic;       ///< topic of the gyroscope; empty: none is used
  std::vector<std::string> transform_topics;
  std::string odom_frame;
  std::string base_frame;                ///< the robot's frame, which odometry moves
  TransformTree transforms;              ///< transforms that were read while the frames were searched
  std::vector<std::string> assumptions;  ///< see FrameSource::assumptions()

  /// Names of all topics to read.
  std::vector<std::string> topics() const;
};

/// Plans how to read a bag. Scans are laser scans, or point clouds if `options.slice_z_m` is set. Finds the
/// topics by their types, or by the names that the user states. Then reads until all frames are known, or to
/// the end; of several topics of odometry, those count that HeardOdometry finds within `look_over_s`. If the
/// user names no topic, plans to read all lasers whose mounts are known. Assumes that the only laser is at
/// the robot's centre if its mount is unknown. Throws UserError if there are no scans, or if something that
/// the user names is missing. `path` names the bag in messages.
BagPlan plan_bag(std::unique_ptr<BagFile> bag, const std::filesystem::path& path, const LogOptions& options,
                 double look_over_s);

}  // namespace psi_slam
