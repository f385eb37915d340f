// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/odometry_interpolator.h"

#include <gtest/gtest.h>

#include <vector>

namespace psi_slam {
namespace {

Frame scan_at(TimeUs time_us) {
  Frame frame;
  frame.time_us = time_us;
  return frame;
}

TEST(OdometryInterpolator, waits_for_odometry_of_the_scans_time_or_later) {
  OdometryInterpolator interpolator;
  interpolator.add_odometry(1'000'000, {1, 0, 0});
  interpolator.add_scan(scan_at(1'250'000));
  EXPECT_FALSE(interpolator.take());
  interpolator.add_odometry(1'200'000, {2, 0, 0});
  EXPECT_FALSE(interpolator.take()) << "the newest odometry is still earlier than the scan";
  interpolator.add_odometry(1'400'000, {6, 0, 0.4});
  const auto frame = interpolator.take();
  ASSERT_TRUE(frame);
  EXPECT_NEAR(frame->odom_T_robot.x, 3, 1e-12);
  EXPECT_NEAR(frame->odom_T_robot.phi, 0.1, 1e-12);
  EXPECT_FALSE(interpolator.take());
}

TEST(OdometryInterpolator, returns_scans_at_once_if_no_odometry_is_expected) {
  OdometryInterpolator interpolator;
  interpolator.add_scan(scan_at(1));
  EXPECT_FALSE(interpolator.take());
  interpolator.expect_no_odometry();
  interpolator.add_odometry(1, {1, 0, 0});
  interpolator.add_scan(scan_at(2));
  for (const TimeUs time_us : {1, 2}) {
    const auto frame = interpolator.take();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->time_us, time_us);
    EXPECT_FALSE(frame->has_odometry);
  }
}

TEST(OdometryInterpolator, returns_the_message_at_its_own_time) {
  OdometryInterpolator interpolator;
  interpolator.add_odometry(10, {1, 2, 3});
  interpolator.add_odometry(20, {4, 5, -3});
  interpolator.add_scan(scan_at(20));
  EXPECT_EQ(interpolator.take()->odom_T_robot, (mrpt::math::TPose2D{4, 5, -3}));
}

TEST(OdometryInterpolator, holds_the_pose_constant_beyond_both_ends) {
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

TEST(OdometryInterpolator, keeps_the_order_of_scans_if_time_runs_backwards) {
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

constexpr TimeUs kSecond = 1'000'000;

std::vector<double> poses_taken(OdometryInterpolator& interpolator) {
  std::vector<double> poses;
  while (const auto frame = interpolator.take()) poses.push_back(frame->odom_T_robot.x);
  return poses;
}

TEST(OdometryInterpolator, takes_the_message_of_the_same_time_where_time_runs_backwards) {
  for (const bool odometry_is_first : {true, false}) {
    OdometryInterpolator interpolator;
    std::vector<double> x_m;
    for (const auto& [time_us, odometry_m] : {std::pair{10, 1.0}, {30, 2.0}, {20, 3.0}, {40, 4.0}}) {
      if (!odometry_is_first) interpolator.add_scan(scan_at(time_us));
      interpolator.add_odometry(time_us, {odometry_m, 0, 0});
      if (odometry_is_first) interpolator.add_scan(scan_at(time_us));
      while (const auto frame = interpolator.take()) x_m.push_back(frame->odom_T_robot.x);
    }
    interpolator.end_of_log();
    while (const auto frame = interpolator.take()) x_m.push_back(frame->odom_T_robot.x);
    EXPECT_EQ(x_m, (std::vector<double>{1, 2, 3, 4})) << odometry_is_first;
  }
}

TEST(OdometryInterpolator, follows_a_clock_that_is_set_back) {
  for (const TimeUs step : {-3600 * kSecond, -5 * kSecond}) {
    SCOPED_TRACE(step);
    OdometryInterpolator interpolator;
    for (int i = 0; i <= 100; ++i) interpolator.add_odometry(i * kSecond, {1.0 * i, 0, 0});
    interpolator.add_scan(scan_at(100 * kSecond + kSecond / 4));         // last of the old clock
    interpolator.add_scan(scan_at(100 * kSecond + kSecond / 2 + step));  // first of the new clock
    interpolator.add_scan(scan_at(100 * kSecond + 3 * kSecond / 4 + step));
    EXPECT_FALSE(interpolator.take()) << "the first odometry of the new clock has not arrived yet";
    interpolator.add_odometry(101 * kSecond + step, {101, 0, 0});
    EXPECT_EQ(poses_taken(interpolator), (std::vector<double>{100, 101, 101}));
    interpolator.add_scan(scan_at(101 * kSecond + kSecond / 2 + step));
    EXPECT_FALSE(interpolator.take());
    interpolator.add_odometry(102 * kSecond + step, {102, 0, 0});
    EXPECT_EQ(poses_taken(interpolator), (std::vector<double>{101.5}));
  }
}

TEST(OdometryInterpolator, a_first_scan_between_old_and_new_time_waits) {
  OdometryInterpolator interpolator;
  for (int i = 3600; i <= 3700; ++i) interpolator.add_odometry(i * kSecond, {1.0 * i, 0, 0});
  interpolator.add_scan(scan_at(100 * kSecond));
  EXPECT_FALSE(interpolator.take());
  interpolator.add_odometry(101 * kSecond, {3701, 0, 0});
  EXPECT_EQ(poses_taken(interpolator), (std::vector<double>{3701}));
}

TEST(OdometryInterpolator, scans_of_the_old_clock_do_not_wait_for_the_new) {
  OdometryInterpolator interpolator;
  interpolator.add_odometry(3600 * kSecond, {1, 0, 0});
  interpolator.add_scan(scan_at(3605 * kSecond));
  interpolator.add_odometry(3601 * kSecond, {2, 0, 0});
  EXPECT_FALSE(interpolator.take());
  interpolator.add_odometry(0, {3, 0, 0});
  EXPECT_EQ(poses_taken(interpolator), (std::vector<double>{2}));
}

TEST(OdometryInterpolator, a_scan_outside_all_times_gets_a_neighbour_in_the_log) {
  OdometryInterpolator interpolator;
  for (int i = 1000; i <= 1100; ++i) {
    interpolator.add_odometry(i * kSecond, {1.0 * i, 0, 0});
    if (i == 1050) interpolator.add_scan(scan_at(7 * kSecond));
  }
  EXPECT_EQ(poses_taken(interpolator), (std::vector<double>{1050}))
      << "the neighbour in the log, not the oldest message";
}

TEST(OdometryInterpolator, stops_waiting_if_odometry_has_stopped) {
  OdometryInterpolator interpolator;
  interpolator.add_odometry(0, {7, 0, 0});
  for (std::size_t i = 0; i <= OdometryInterpolator::kMaxWaiting; ++i) interpolator.add_scan(scan_at(100));
  EXPECT_EQ(interpolator.take()->odom_T_robot.x, 7);
  EXPECT_FALSE(interpolator.take()) << "later scans may still get odometry";
}

}  // namespace
}  // namespace psi_slam
