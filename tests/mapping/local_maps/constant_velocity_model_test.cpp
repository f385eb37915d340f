// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/constant_velocity_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr TimeUs kSecond = 1'000'000;

/// Pose on a circle with a radius of 2 m, after a turn of `turn_rad` from the origin.
TPose2D on_circle(double turn_rad) {
  return {2 * std::sin(turn_rad), 2 * (1 - std::cos(turn_rad)), turn_rad};
}

TEST(ConstantVelocityModel, continues_along_its_arc) {
  ConstantVelocityModel robot;
  robot.moved(0, on_circle(0), false);
  robot.moved(kSecond / 4, on_circle(0.1), true);
  const TPose2D motion = robot.predict(3 * kSecond / 4).motion;
  const TPose2D truth = on_circle(0.3) - on_circle(0.1);
  EXPECT_NEAR(motion.x, truth.x, 0.005);
  EXPECT_NEAR(motion.y, truth.y, 0.005);
  EXPECT_NEAR(motion.phi, truth.phi, 1e-9);
}

TEST(ConstantVelocityModel, predicts_no_motion_before_the_first_pose) {
  ConstantVelocityModel robot;
  EXPECT_EQ(robot.predict(kSecond).sigma_m, 0) << "there is no pose yet";
  robot.moved(0, {3, 4, 1}, false);
  const PredictedMotion predicted = robot.predict(2 * kSecond);
  EXPECT_EQ(predicted.motion, TPose2D(0, 0, 0));
  EXPECT_NEAR(predicted.sigma_m, 1, 1e-9);
  EXPECT_NEAR(predicted.sigma_rad, M_PI / 3, 1e-9);
}

TEST(ConstantVelocityModel, uncertainty_grows_with_time) {
  ConstantVelocityModel robot;
  robot.moved(0, {0, 0, 0}, true);
  robot.moved(kSecond, {1, 0, 0}, true);
  EXPECT_NEAR(robot.predict(kSecond + kSecond / 10).sigma_m, 0.01, 1e-9);
  EXPECT_NEAR(robot.predict(2 * kSecond).sigma_m, 1, 1e-9);
  EXPECT_EQ(robot.predict(kSecond / 2).sigma_m, 0) << "time that runs backwards counts as zero";
}

TEST(ConstantVelocityModel, predicted_poses_do_not_change_the_speed) {
  ConstantVelocityModel robot;
  robot.moved(0, {0, 0, 0}, true);
  robot.moved(kSecond, {1, 0, 0}, true);
  robot.moved(2 * kSecond, {1.5, 0, 0}, false);
  EXPECT_NEAR(robot.predict(3 * kSecond).motion.x, 1, 1e-9);
  EXPECT_EQ(robot.predict(4 * kSecond).motion.x, 0) << "the speed is unknown after 3 s without a match";
}

TEST(ConstantVelocityModel, measures_no_speed_between_the_middle_and_the_beginning_of_sweeps) {
  ConstantVelocityModel robot;  // a sweep takes half a period, so its middle is at a quarter
  robot.moved(0, {0.25, 0, 0}, true, {}, true);
  robot.moved(kSecond, {1.25, 0, 0}, true, {}, true);
  robot.moved(2 * kSecond, {2, 0, 0}, true);
  EXPECT_NEAR(robot.predict(3 * kSecond).motion.x, 1, 1e-9) << "0.75 m is not the motion in one second";
  robot.moved(3 * kSecond, {3.5, 0, 0}, true);
  EXPECT_NEAR(robot.predict(4 * kSecond).motion.x, 1.5, 1e-9);
}

TEST(ConstantVelocityModel, uncertainty_since_the_last_match_includes_unmatched_scans) {
  ConstantVelocityModel robot;
  robot.moved(0, {0, 0, 0}, true);
  robot.moved(kSecond, {1, 0, 0}, true);
  robot.moved(2 * kSecond, {2, 0, 0}, false);
  const PredictedMotion near = robot.predict(2 * kSecond + kSecond / 2);
  EXPECT_NEAR(near.sigma_m, 0.25, 1e-9);
  EXPECT_NEAR(near.sigma_since_match_m, 2.25, 1e-9);
  const PredictedMotion far = robot.predict(4 * kSecond);
  EXPECT_NEAR(far.sigma_m, 0.5 * 2, 1e-9);
  EXPECT_NEAR(far.sigma_since_match_m, 0.5 * 3, 1e-9);
}

// A robot at 1 m/s, whose scans at 10 Hz have time stamps that jitter by half a second.
TEST(ConstantVelocityModel, counts_scans_if_time_stamps_step_back) {
  ConstantVelocityModel robot;
  const std::vector<TimeUs> stamps_ms{0,    100,  200,  300,  900,  500,  600,  1200, 800,  900,
                                      1500, 1100, 1200, 1300, 1900, 1500, 1600, 1700, 1800, 2400};
  for (std::size_t i = 0; i < stamps_ms.size(); ++i)
    robot.moved(stamps_ms[i] * 1000, {0.1 * static_cast<double>(i), 0, 0}, true);
  const double expected_m = robot.predict(2'000'000).motion.x;
  EXPECT_NEAR(expected_m, 0.1, 0.03) << "the stamp steps back by 0.4 s";
  EXPECT_EQ(robot.predict(3'000'000).motion.x, expected_m) << "the time stamps no longer matter";
}

TEST(ConstantVelocityModel, scans_at_one_time_give_no_speed) {
  ConstantVelocityModel robot;
  robot.moved(0, {0, 0, 0}, true);
  robot.moved(0, {0.1, 0, 0}, true);
  EXPECT_EQ(robot.predict(kSecond).motion, TPose2D(0, 0, 0));
}

TEST(ConstantVelocityModel, a_gyroscope_predicts_the_turn) {
  ConstantVelocityModel robot;
  robot.moved(0, {0, 0, 0}, true, 5.0);
  robot.moved(kSecond / 2, {0.5, 0, 0}, true, 5.0);
  const PredictedMotion predicted = robot.predict(kSecond, 6.0);
  EXPECT_NEAR(predicted.motion.phi, 1, 1e-9);
  EXPECT_NEAR(predicted.motion.x, 0.5 * std::cos(0.5), 1e-9) << "the robot moves along an arc";
  EXPECT_NEAR(predicted.motion.y, 0.5 * std::sin(0.5), 1e-9);
  const PredictedMotion steady = robot.predict(kSecond);
  EXPECT_EQ(steady.motion.phi, 0);
  EXPECT_LT(predicted.sigma_rad, 0.2 * steady.sigma_rad);
  EXPECT_LT(predicted.sigma_since_match_rad, 0.2 * steady.sigma_since_match_rad);
  EXPECT_EQ(predicted.sigma_without_gyroscope_rad, steady.sigma_since_match_rad);
  EXPECT_EQ(predicted.sigma_m, steady.sigma_m);
}

TEST(ConstantVelocityModel, a_gyroscope_predicts_turns_only_between_scans_with_a_heading) {
  ConstantVelocityModel robot;
  EXPECT_EQ(robot.predict(0, 5.0).motion.phi, 0) << "there is no pose yet";
  robot.moved(0, {0, 0, 0}, true);
  EXPECT_EQ(robot.predict(kSecond / 2, 5.0).motion.phi, 0);
  robot.moved(kSecond / 2, {0, 0, 0.25}, true, 5.0);
  EXPECT_NEAR(robot.predict(kSecond).motion.phi, 0.25, 1e-9);
  EXPECT_NEAR(robot.predict(kSecond, 5.5).motion.phi, 0.5, 1e-9);
}

TEST(ConstantVelocityModel, unknown_turns_since_the_last_match_widen_the_window) {
  ConstantVelocityModel robot;
  robot.moved(0, {0, 0, 0}, true, 0.0);
  robot.moved(kSecond, {0, 0, 0}, true, 0.0);
  robot.moved(3 * kSecond / 2, {0, 0, 0}, false);
  robot.moved(2 * kSecond, {0, 0, 0}, false, 1.0);
  const PredictedMotion predicted = robot.predict(5 * kSecond / 2, 1.5);
  EXPECT_NEAR(predicted.motion.phi, 0.5, 1e-9);
  EXPECT_EQ(predicted.sigma_since_match_rad, predicted.sigma_without_gyroscope_rad);
}

// The robot turns left and right in turns; the gyroscope reports nothing.
TEST(ConstantVelocityModel, a_dead_gyroscope_is_ignored) {
  ConstantVelocityModel robot;
  TPose2D pose(0, 0, 0);
  TimeUs time_us = 0;
  for (int i = 0; i < 60; ++i, time_us += kSecond / 10) {
    pose.phi += 0.1 * (i / 10 % 2 == 0 ? 1 : -1);
    robot.moved(time_us, pose, true, 0.0);
  }
  EXPECT_NEAR(robot.predict(time_us, 0.0).motion.phi, -0.1, 1e-9);
}

}  // namespace
}  // namespace psi_slam
