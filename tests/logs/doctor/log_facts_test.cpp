// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/log_facts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulated_run.h"

namespace psi_slam {
namespace {

Frame frame_at(double time_s, const mrpt::math::TPose2D& pose = {0, 0, 0},
               std::vector<float> ranges_m = {1, 2, 3}) {
  Frame frame;
  frame.time_us = std::llround(time_s * 1e6);
  frame.odom_T_robot = pose;
  frame.scan.bearings_rad =
      std::make_shared<const std::vector<float>>(make_bearings_rad(BeamAngles::kAuto, ranges_m.size(), 2));
  frame.scan.ranges_m = std::move(ranges_m);
  return frame;
}

LogFacts facts_of(const std::vector<Frame>& frames, float max_range_m = 50) {
  LogFactsCollector collector;
  for (const Frame& frame : frames) collector.add(frame, max_range_m);
  EXPECT_EQ(collector.marks().size(), frames.size());
  return collector.facts();
}

TEST(LogFacts, measure_time_in_the_order_of_the_file) {
  std::vector<Frame> frames;
  for (int i = 0; i < 20; ++i) frames.push_back(frame_at(10 + 0.2 * i));
  frames.push_back(frame_at(17));     // gap of 3.2 s
  frames.push_back(frame_at(16.25));  // time runs backwards
  frames.push_back(frame_at(16.25));  // repeats the previous scan
  frames.push_back(frame_at(16.25, {0, 0, 0}, {1, 2, 4}));
  const TimeFacts time = facts_of(frames).time;
  EXPECT_EQ(time.first_us, 10'000'000);
  EXPECT_EQ(time.last_us, 16'250'000);
  EXPECT_DOUBLE_EQ(time.duration_s, 7);
  EXPECT_NEAR(time.median_period_s, 0.2, 1e-9);
  EXPECT_EQ(time.gaps, 1U);
  EXPECT_NEAR(time.largest_gap_s, 3.2, 1e-9);
  EXPECT_EQ(time.backward_steps, 1U);
  EXPECT_NEAR(time.largest_backward_step_s, 0.75, 1e-9);
  EXPECT_EQ(time.repeated_stamps, 2U);
  EXPECT_EQ(time.repeated_scans, 1U);
}

TEST(LogFacts, sum_path_and_turns) {
  const OdometryFacts odometry =
      facts_of({frame_at(0), frame_at(1, {3, 4, 3}), frame_at(2, {3, 3, -3}), frame_at(3, {3, 3, -3})})
          .odometry;
  EXPECT_DOUBLE_EQ(odometry.path_length_m, 6);
  EXPECT_DOUBLE_EQ(odometry.largest_step_m, 5);
  EXPECT_NEAR(odometry.turned_rad, 3 + (2 * M_PI - 6), 1e-12);
  EXPECT_NEAR(odometry.largest_turn_rad, 3, 1e-12);
}

TEST(LogFacts, count_returns_and_empty_scans) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const RangeFacts ranges =
      facts_of({frame_at(0, {}, {1, 2, 60}), frame_at(1, {}, {nan, 50, 51}), frame_at(2, {}, {3, nan, 1})})
          .ranges;
  EXPECT_EQ(ranges.readings, 9U);
  EXPECT_EQ(ranges.returns, 4U);
  EXPECT_EQ(ranges.empty_scans, 1U);
  EXPECT_FLOAT_EQ(ranges.largest_reading_m, 60);
  EXPECT_FLOAT_EQ(ranges.median_return_m, 1);
}

TEST(LogFacts, count_scans_of_another_shape) {
  const LogFacts facts = facts_of({frame_at(0), frame_at(1), frame_at(2, {}, {1, 2})});
  EXPECT_EQ(facts.scans, 3U);
  EXPECT_EQ(facts.beams, 3U);
  EXPECT_EQ(facts.scans_of_other_shape, 1U);
  EXPECT_NEAR(facts.first_bearing_rad, -1, 1e-6);
  EXPECT_NEAR(facts.last_bearing_rad, 1, 1e-6);
}

TEST(LogFacts, are_zero_for_an_empty_log) {
  const LogFacts facts = facts_of({});
  EXPECT_EQ(facts.scans, 0U);
  EXPECT_EQ(facts.time.duration_s, 0);
  EXPECT_EQ(facts_of({frame_at(5)}).time.median_period_s, 0);
}

}  // namespace
}  // namespace psi_slam
