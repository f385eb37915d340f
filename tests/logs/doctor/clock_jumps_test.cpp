// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/clock_jumps.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

constexpr double kPeriod_s = 0.2;

/// Ten frames of a robot that moves by `step_m` each period.
std::vector<FrameMark> drive(double step_m) {
  std::vector<FrameMark> marks;
  for (int i = 0; i < 10; ++i) marks.push_back({200'000 * i, {step_m * i, 0, 0}});
  return marks;
}

/// The marks with `passed_s` added before frame 5.
std::vector<FrameMark> with_jump(std::vector<FrameMark> marks, double passed_s) {
  for (std::size_t i = 5; i < marks.size(); ++i) marks[i].time_us += static_cast<TimeUs>(passed_s * 1e6);
  return marks;
}

TEST(ClockJumps, are_steps_back_and_gaps_without_their_motion) {
  EXPECT_TRUE(clock_jumps(drive(0.1), kPeriod_s, true).empty());
  for (const double passed_s : {-20.0, 30.0}) {
    const auto jumps = clock_jumps(with_jump(drive(0.1), passed_s), kPeriod_s, true);
    ASSERT_EQ(jumps.size(), 1U) << passed_s;
    EXPECT_EQ(jumps[0].frame, 5U);
    EXPECT_NEAR(jumps[0].jump_s, passed_s + kPeriod_s, 1e-9);
  }
}

TEST(ClockJumps, are_not_small_steps_back_and_true_gaps) {
  EXPECT_TRUE(clock_jumps(with_jump(drive(0.1), -1), kPeriod_s, true).empty()) << "messages out of order";
  EXPECT_TRUE(clock_jumps(with_jump(drive(0.1), 4), kPeriod_s, true).empty());
  EXPECT_TRUE(clock_jumps(with_jump(drive(0.1), 4.9), 0.3, true).empty()) << "less than 20 periods";
  EXPECT_TRUE(clock_jumps(with_jump(drive(0), 30), kPeriod_s, true).empty()) << "the robot stands";
  EXPECT_TRUE(clock_jumps(with_jump(drive(0.1), 30), kPeriod_s, false).empty()) << "the motion is unknown";
  EXPECT_EQ(clock_jumps(with_jump(drive(0.1), -20), kPeriod_s, false).size(), 1U);
  for (const double moved_m : {-0.1, 1.0}) {
    std::vector<FrameMark> marks = with_jump(drive(0.1), 30);
    for (std::size_t i = 5; i < marks.size(); ++i) marks[i].odom_T_robot.x += moved_m;
    EXPECT_TRUE(clock_jumps(marks, kPeriod_s, true).empty())
        << "stopped, moved on, or was carried: " << moved_m;
  }
}

TEST(ClockJumps, are_no_pauses_in_a_log_that_is_thinned_by_distance) {
  std::vector<FrameMark> marks;
  TimeUs time_us = 0;
  for (int i = 0; i < 100; ++i) {
    marks.push_back({time_us, {0.2 * i, 0, 0}});
    time_us += i % 30 == 29 ? 40'000'000 : 450'000 + 10'000 * (i % 7);
  }
  EXPECT_TRUE(clock_jumps(marks, 0.48, true).empty());
  for (int i = 0; i < 5; ++i) marks.insert(marks.begin(), {-500'000 * (i + 1), {0, 0, 0}});
  EXPECT_EQ(clock_jumps(marks, 0.48, true).size(), 3U) << "scans of a robot at rest";
}

TEST(ClockJumps, are_found_of_a_robot_that_never_rests_and_whose_stamps_jitter) {
  std::vector<FrameMark> marks;
  double x_m = 0;
  for (int i = 0; i < 100; ++i) {
    marks.push_back({200'000 * i + 9'000 * (i % 3), {x_m, 0, 0}});
    x_m += 0.15 + 0.06 * std::sin(0.3 * i);  // its speed varies
  }
  EXPECT_TRUE(clock_jumps(marks, kPeriod_s, true).empty());
  EXPECT_EQ(clock_jumps(with_jump(marks, 30), kPeriod_s, true).size(), 1U);
}

}  // namespace
}  // namespace psi_slam
