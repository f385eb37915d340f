// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/log_options.h"
#include "rosbag/bag_file.h"
#include "rosbag/ros_messages.h"

namespace psi_slam {

/// Tree of the frames in /tf and /tf_static. Keeps the last pose of each frame in its parent.
class TransformTree {
 public:
  void add(const RosTransform& transform);

  /// Returns `frame` and the frames above it, up to the root.
  std::vector<std::string> way_up(const std::string& frame) const;

  /// Returns a frame whose parent satisfies a predicate, or nothing. Prefers frames with "base" in the name.
  std::optional<std::string> child_of(const std::function<bool(const std::string& parent)>& is_parent) const;

  /// Returns the parent of `frame`; empty if it has none.
  std::string parent_of(const std::string& frame) const;

  /// Returns the pose of `frame` in `base`, or nothing if they are not connected.
  std::optional<mrpt::poses::CPose3D> base_T_frame(const std::string& base, const std::string& frame) const;

  /// Each frame with its parent, for error messages: "base_link < odom, laser < base_link".
  std::string text() const;

 private:
  struct Link {
    std::string parent;
    mrpt::poses::CPose3D parent_T_frame;
  };

  /// Returns the pose of a frame in the frame that is `steps` above it.
  mrpt::poses::CPose3D above_T_frame(std::string frame, std::size_t steps) const;

  std::map<std::string, Link> links_;  // key: name of the child frame
};

/// The topics and frames to read from a ROS bag.
struct BagPlan {
  std::vector<std::string> scan_topics;  ///< index: LaserScan::laser
  bool has_odometry = false;             ///< false: scans have no odometry
  std::string odometry_topic;            ///< empty: odometry is the transform from odom_frame to base_frame
  std::string imu_topic;                 ///< topic of the gyroscope; empty: none is used
  std::vector<std::string> transform_topics;
  std::string odom_frame;
  std::string base_frame;                ///< the robot's frame, which odometry moves
  TransformTree transforms;              ///< transforms that were read while the frames were searched
  std::vector<std::string> assumptions;  ///< see FrameSource::assumptions()

  /// Names of all topics to read.
  std::vector<std::string> topics() const;
};

/// Error message for odometry with an invalid pose, without the place.
std::string invalid_pose_text(const std::string& topic);

/// Returns whether the messages of the topic are transforms.
bool is_transforms(const BagTopic& topic);

/// Returns the options for the laser of a topic, with its stated mount.
LogOptions options_of_topic(const LogOptions& options, const std::string& topic);

/// Plans how to read a bag. Scans are laser scans, or point clouds if `options.slice_z_m` is set. Finds the
/// topics by their types, or by the names that the user states. Then reads until all frames are known, or to
/// the end. If the user names no topic, plans to read all lasers whose mounts are known. Assumes that the
/// only laser is at the robot's centre if its mount is unknown. Throws UserError if there are no scans, or if
/// something that the user names is missing.
BagPlan plan_bag(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
