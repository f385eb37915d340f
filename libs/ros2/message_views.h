// SPDX-License-Identifier: BSD-3-Clause
// Fills the texts and sequences of the structs that idlc makes. Such a member does not own its bytes: the
// string or vector must live until the message is written.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <string>
#include <vector>

#include "base/portable_math.h"
#include "psi_slam/time_stamp.h"
#include "ros2_messages.h"

namespace psi_slam {

/// The text as DDS takes it. DDS only reads texts that are written.
inline char* dds_text(const std::string& text) {
  return const_cast<char*>(text.c_str());
}

/// Makes `sequence` show the elements of `values`, which must have its type of element.
template <class Sequence, class Value>
void show(Sequence& sequence, std::vector<Value>& values) {
  sequence._maximum = sequence._length = static_cast<std::uint32_t>(values.size());
  sequence._buffer = values.data();
  sequence._release = false;
}

inline builtin_interfaces_msg_dds__Time_ ros_time(TimeUs time_us) {
  std::int64_t second = time_us / 1'000'000;
  std::int64_t micro = time_us % 1'000'000;
  if (micro < 0) {
    micro += 1'000'000;
    --second;
  }
  return {static_cast<std::int32_t>(second), static_cast<std::uint32_t>(micro * 1000)};
}

inline std_msgs_msg_dds__Header_ ros_header(TimeUs time_us, const std::string& frame) {
  return {ros_time(time_us), dds_text(frame)};
}

inline geometry_msgs_msg_dds__Quaternion_ ros_rotation(double yaw_rad) {
  return {0, 0, portable::sin(yaw_rad / 2), portable::cos(yaw_rad / 2)};
}

inline geometry_msgs_msg_dds__Pose_ ros_pose(const mrpt::math::TPose2D& pose) {
  return {{pose.x, pose.y, 0}, ros_rotation(pose.phi)};
}

inline geometry_msgs_msg_dds__TransformStamped_ ros_transform(const std::string& parent,
                                                              const std::string& child,
                                                              const mrpt::math::TPose2D& pose,
                                                              TimeUs time_us) {
  return {ros_header(time_us, parent), dds_text(child), {{pose.x, pose.y, 0}, ros_rotation(pose.phi)}};
}

}  // namespace psi_slam
