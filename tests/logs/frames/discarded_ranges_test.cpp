// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/discarded_ranges.h"

#include <gtest/gtest.h>

#include "simulated_room.h"

namespace psi_slam {
namespace {

TEST(DiscardedRanges, leave_times_odometry_and_mounts) {
  Frame frame = SimulatedRoom().scan_from({1, 1, 0.5}, even_bearings(-1, 1, 11));
  frame.time_us = 7;
  frame.companions.push_back({frame.scan, 8, {0.01, 0, 0}});
  ASSERT_TRUE(has_ranges(frame));
  discard_ranges(frame);
  EXPECT_FALSE(has_ranges(frame));
  EXPECT_EQ(frame.scan.ranges_m.capacity(), 0U);
  EXPECT_EQ(frame.scan.bearings_rad->size(), frame.scan.ranges_m.size());
  EXPECT_EQ(frame.time_us, 7);
  EXPECT_EQ(frame.odom_T_robot, mrpt::math::TPose2D(1, 1, 0.5));
  EXPECT_EQ(frame.scan.robot_T_laser.x, 0.1);
  ASSERT_EQ(frame.companions.size(), 1U);
  EXPECT_EQ(frame.companions[0].time_us, 8);
}

TEST(DiscardedRanges, a_frame_with_the_scan_of_any_laser_has_ranges) {
  Frame frame = SimulatedRoom().scan_from({1, 1, 0.5}, even_bearings(-1, 1, 11));
  const LaserScan scan = frame.scan;
  discard_ranges(frame);
  frame.companions.push_back({scan, 8, {}});
  EXPECT_TRUE(has_ranges(frame));
}

}  // namespace
}  // namespace psi_slam
