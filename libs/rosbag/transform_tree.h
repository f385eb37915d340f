// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rosbag/ros_messages.h"

namespace psi_slam {

/// Frames of /tf and /tf_static, each with the newest pose in its parent.
class TransformTree {
 public:
  void add(const RosTransform& transform);

  /// Returns the frame and the frames above it, up to the root.
  std::vector<std::string> way_up(const std::string& frame) const;

  /// Returns the pose of `frame` in `base`, or nothing if they are not connected.
  std::optional<mrpt::poses::CPose3D> base_T_frame(const std::string& base, const std::string& frame) const;

  /// Each frame with its parent for messages: "base_link < odom, laser < base_link".
  std::string text() const;

 private:
  struct Link {
    std::string parent;
    mrpt::poses::CPose3D parent_T_frame;
  };

  /// Returns the pose of a frame in the frame that is `steps` above it.
  mrpt::poses::CPose3D above_T_frame(std::string frame, std::size_t steps) const;

  std::map<std::string, Link> links_;  // by frame
};

}  // namespace psi_slam
