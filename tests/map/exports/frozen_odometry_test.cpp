// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/frozen_odometry.h"

#include <gmock/gmock.h>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// A robot whose odometry is `odom_T_robot` and whose map places it at `map_T_robot`, once a second.
void add_scan(MappingResult& result, const TPose2D& odom_T_robot, const TPose2D& map_T_robot) {
  Frame frame;
  frame.time_us = static_cast<TimeUs>(result.log.size()) * 1'000'000;
  frame.odom_T_robot = odom_T_robot;
  FrameRecord record;
  record.time_us = frame.time_us;
  record.odom_T_robot = odom_T_robot;
  record.front_end_T_robot = record.map_T_robot = map_T_robot;
  result.log.push_back(frame);
  result.frames.push_back(record);
}

TEST(FrozenOdometry, is_named_with_its_time_and_the_motion_of_the_robot) {
  MappingResult result;
  for (int i = 0; i < 10; ++i) add_scan(result, {0.3 * i, 0, 0}, {0.3 * i, 0, 0});
  for (int i = 10; i < 20; ++i) add_scan(result, {0.3 * 9, 0, 0}, {0.3 * i, 0, 0.1 * (i - 9)});
  for (int i = 20; i < 25; ++i) add_scan(result, {0.3 * (i - 10), 0, 0}, {0.3 * i, 0, 1});
  EXPECT_EQ(
      frozen_odometry_text(result),
      "odometry did not change in 10 scans although the robot moved, most from 0:09 to 0:19: 3.0 m and 57 "
      "degrees. The scans alone determined its motion there. Check the wheel encoders and their driver");
}

TEST(FrozenOdometry, is_not_a_robot_at_rest_whose_poses_have_errors) {
  MappingResult result;
  for (int i = 0; i < 1000; ++i)
    add_scan(result, {1, 2, 0.5}, {1 + 0.05 * (i % 2), 2 - 0.05 * (i % 3), 0.5 + 0.02 * (i % 4)});
  EXPECT_EQ(frozen_odometry_text(result), std::nullopt);
}

// The odometry of some robots comes late, and then jumps to where the robot is.
TEST(FrozenOdometry, is_not_a_short_delay) {
  MappingResult result;
  for (int i = 0; i < 20; ++i) add_scan(result, {0.6 * (i / 2 * 2), 0, 0}, {0.6 * i, 0, 0});
  EXPECT_EQ(frozen_odometry_text(result), std::nullopt);
}

TEST(FrozenOdometry, is_not_a_log_without_odometry) {
  MappingResult result;
  for (int i = 0; i < 20; ++i) add_scan(result, {0, 0, 0}, {0.3 * i, 0, 0});
  for (Frame& frame : result.log) frame.has_odometry = false;
  EXPECT_EQ(frozen_odometry_text(result), std::nullopt);
}

// Two runs may begin with the same odometry.
TEST(FrozenOdometry, does_not_span_two_runs) {
  MappingResult result;
  add_scan(result, {0, 0, 0}, {0, 0, 0});
  add_scan(result, {0, 0, 0}, {5, 0, 0});
  result.later_run_frames = {1};
  EXPECT_EQ(frozen_odometry_text(result), std::nullopt);
}

}  // namespace
}  // namespace psi_slam
