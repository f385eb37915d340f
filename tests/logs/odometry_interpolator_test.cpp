// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/odometry_interpolator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

Frame scan_at(TimeUs time_us) {
  Frame frame;
  frame.time_us = time_us;
  return frame;
}

TEST(OdometryInterpolator, turns_the_shorter_way_round) {
  const auto middle = interpolate({0, 0, M_PI - 0.1}, {2, 4, -M_PI + 0.3}, 0.5);
  EXPECT_DOUBLE_EQ(middle.x, 1);
  EXPECT_DOUBLE_EQ(middle.y, 2);
  EXPECT_NEAR(middle.phi, -M_PI + 0.1, 1e-12);
}

TEST(OdometryInterpolator, waits_for_odometry_as_late_as_the_scan) {
  OdometryInterpolator interpolator;
  interpolator.add_odometry(1'000'000, {1, 0, 0});
  interpolator.add_scan(scan_at(1'250'000));
  EXPECT_FALSE(interpolator.take());
  interpolator.add_odometry(1'200'000, {2, 0, 0});
  EXPECT_FALSE(interpolator.take()) << "still earlier than the scan";
  interpolator.add_odometry(1'400'000, {6, 0, 0.4});
  const auto frame = interpolator.take();
  ASSERT_TRUE(frame);
  EXPECT_NEAR(frame->odom_T_robot.x, 3, 1e-12);
  EXPECT_NEAR(frame->odom_T_robot.phi, 0.1, 1e-12);
  EXPECT_FALSE(interpolator.take());
}

TEST(OdometryInterpolator, gives_the_message_itself_at_its_own_time) {
  OdometryInterpolator interpolator;
  interpolator.add_odometry(10, {1, 2, 3});
  interpolator.add_odometry(20, {4, 5, -3});
  interpolator.add_scan(scan_at(20));
  EXPECT_EQ(interpolator.take()->odom_T_robot, (mrpt::math::TPose2D{4, 5, -3}));
}

TEST(OdometryInterpolator, clamps_at_both_ends) {
  OdometryInterpolator interpolator;
  interpolator.add_scan(scan_at(1));
  EXPECT_FALSE(interpolator.take()) << "no odometry yet";
  interpolator.add_odometry(10, {1, 0, 0});
  interpolator.add_odometry(20, {2, 0, 0});
  interpolator.add_scan(scan_at(30));
  EXPECT_EQ(interpolator.take()->odom_T_robot.x, 1);
  EXPECT_FALSE(interpolator.take());
  interpolator.end_of_log();
  EXPECT_EQ(interpolator.take()->odom_T_robot.x, 2);
}

TEST(OdometryInterpolator, keeps_the_order_of_scans_whose_time_runs_backwards) {
  OdometryInterpolator interpolator;
  interpolator.add_odometry(0, {0, 0, 0});
  interpolator.add_scan(scan_at(150));
  interpolator.add_scan(scan_at(50));
  interpolator.add_odometry(100, {1, 0, 0});
  EXPECT_FALSE(interpolator.take());
  interpolator.add_odometry(200, {2, 0, 0});
  EXPECT_DOUBLE_EQ(interpolator.take()->odom_T_robot.x, 1.5);
  EXPECT_DOUBLE_EQ(interpolator.take()->odom_T_robot.x, 0.5);
}

TEST(OdometryInterpolator, does_not_wait_forever_when_odometry_has_stopped) {
  OdometryInterpolator interpolator;
  interpolator.add_odometry(0, {7, 0, 0});
  for (std::size_t i = 0; i <= OdometryInterpolator::kMaxWaiting; ++i) interpolator.add_scan(scan_at(100));
  EXPECT_EQ(interpolator.take()->odom_T_robot.x, 7);
  EXPECT_FALSE(interpolator.take()) << "the others may still get theirs";
}

}  // namespace
}  // namespace psi_slam
