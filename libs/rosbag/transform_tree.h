// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rosbag/ros_messages.h"

namespace psi_slam {

/// The frames that /tf and /tf_static tell of, each with the newest pose in its parent.
class TransformTree {
 public:
  void add(const RosTransform& transform);

  /// The frame and those above it, up to the root.
  std::vector<std::string> way_up(const std::string& frame) const;

  /// The pose of `frame` in `base`; none when nothing connects them.
  std::optional<mrpt::poses::CPose3D> base_T_frame(const std::string& base, const std::string& frame) const;

  /// "base_link < odom, laser < base_link": each frame with its parent, for sentences.
  std::string text() const;

 private:
  struct Link {
    std::string parent;
    mrpt::poses::CPose3D parent_T_frame;
  };

  /// The pose of a frame in the one that many steps above it.
  mrpt::poses::CPose3D above_T_frame(std::string frame, std::size_t steps) const;

  std::map<std::string, Link> links_;  // by frame
};

}  // namespace psi_slam
