// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "logs/rosbag/ros_messages.h"

namespace psi_slam {

/// Returns whether the last part of a frame's name contains a word, in letters of any case.
bool has_word(std::string frame, const char* word);

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

}  // namespace psi_slam
