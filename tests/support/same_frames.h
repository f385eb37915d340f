// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// All values of a frame as bytes, so that two frames compare to the last bit.
inline std::string bytes_of_frame(const Frame& frame) {
  std::string bytes;
  const auto add = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  const auto add_pose = [&](const mrpt::math::TPose2D& pose) { add(pose.x), add(pose.y), add(pose.phi); };
  const auto add_scan = [&](const LaserScan& scan) {
    for (const float range_m : scan.ranges_m) add(range_m);
    for (const float bearing_rad : *scan.bearings_rad) add(bearing_rad);
    add(scan.max_range_m), add(scan.sweep_time_s), add(scan.laser);
    add_pose(scan.robot_T_laser);
  };
  add(frame.index), add(frame.time_us), add(frame.has_odometry);
  if (frame.has_odometry) add_pose(frame.odom_T_robot);
  add(frame.imu_heading_rad.value_or(0));
  add_scan(frame.scan);
  for (const CompanionScan& companion : frame.companions) {
    add(companion.time_us);
    add_pose(companion.frame_T_robot);
    add_scan(companion.scan);
  }
  return bytes;
}

/// Expects that two sources yield the same frames to the last bit, and returns their number.
inline std::size_t expect_same_frames(FrameSource& a, FrameSource& b) {
  std::size_t frames = 0;
  for (;; ++frames) {
    const auto of_a = a.next();
    const auto of_b = b.next();
    EXPECT_EQ(of_a.has_value(), of_b.has_value()) << "after " << frames << " frames";
    if (!of_a || !of_b) return frames;
    if (bytes_of_frame(*of_a) == bytes_of_frame(*of_b)) continue;
    ADD_FAILURE() << "frame " << frames << " differs";
    return frames;
  }
}

}  // namespace psi_slam
