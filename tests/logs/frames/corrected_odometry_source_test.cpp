// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/corrected_odometry_source.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "frames_in_memory.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

Frame frame_at(TimeUs time_us, const TPose2D& odom_T_robot) {
  Frame frame;
  frame.time_us = time_us;
  frame.odom_T_robot = odom_T_robot;
  return frame;
}

std::vector<Frame> numbered(std::vector<Frame> frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].index = i;
  return frames;
}

std::vector<Frame> corrected(const std::vector<Frame>& frames, double scale, double delay_s) {
  CorrectedOdometrySource source(std::make_unique<FramesInMemory>(frames), scale,
                                 [&](std::size_t) { return delay_s; });
  std::vector<Frame> all;
  while (auto frame = source.next()) all.push_back(*std::move(frame));
  return all;
}

/// A run at random speeds. Two lasers scan at random times, and the scans of the second one arrive up to 0.3
/// s late.
std::vector<Frame> random_run(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<std::pair<double, Frame>> by_arrival;
  TPose2D odom_T_robot{5, -3, 3};
  double time_s = 100;
  for (int i = 0; i < 300; ++i) {
    time_s += 0.01 + 0.1 * share(random);
    odom_T_robot = odom_T_robot + TPose2D{0.1 * share(random), 0.01 * share(random), share(random) - 0.4};
    Frame frame = frame_at(std::llround(1e6 * time_s), odom_T_robot);
    frame.scan.laser = i % 2;
    by_arrival.emplace_back(time_s + (i % 2) * 0.3 * share(random), frame);
  }
  std::stable_sort(by_arrival.begin(), by_arrival.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Frame> frames;
  for (auto& [arrival_s, frame] : by_arrival) frames.push_back(std::move(frame));
  return numbered(std::move(frames));
}

/// Odometry at a time, by comparing the time with all frames.
TPose2D interpolated(std::vector<Frame> frames, TimeUs time_us) {
  std::sort(frames.begin(), frames.end(),
            [](const Frame& a, const Frame& b) { return a.time_us < b.time_us; });
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const Frame& before = frames[i - 1];
    const Frame& after = frames[i];
    if (time_us < before.time_us || time_us > after.time_us) continue;
    const double share =
        static_cast<double>(time_us - before.time_us) / static_cast<double>(after.time_us - before.time_us);
    const TPose2D step = after.odom_T_robot - before.odom_T_robot;
    return {before.odom_T_robot.x + share * (after.odom_T_robot.x - before.odom_T_robot.x),
            before.odom_T_robot.y + share * (after.odom_T_robot.y - before.odom_T_robot.y),
            before.odom_T_robot.phi + share * step.phi};
  }
  return (time_us < frames.front().time_us ? frames.front() : frames.back()).odom_T_robot;
}

TEST(CorrectedOdometrySource, gives_each_scan_the_odometry_of_its_measurement) {
  const std::vector<Frame> frames = random_run(3);
  for (const double delay_s : {-1.0, -0.3, -0.02, 0.02, 0.25, 1.0}) {
    const std::vector<Frame> result = corrected(frames, 1.1, delay_s);
    ASSERT_EQ(result.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(result[i].index, i);
      EXPECT_EQ(result[i].time_us, frames[i].time_us);
      EXPECT_EQ(result[i].scan.laser, frames[i].scan.laser);
      const TPose2D expected = interpolated(frames, frames[i].time_us - std::llround(1e6 * delay_s));
      EXPECT_NEAR(result[i].odom_T_robot.x, 1.1 * expected.x, 1e-9) << delay_s << " s, frame " << i;
      EXPECT_NEAR(result[i].odom_T_robot.y, 1.1 * expected.y, 1e-9);
      EXPECT_NEAR(mrpt::math::wrapToPi(result[i].odom_T_robot.phi - expected.phi), 0, 1e-9);
    }
  }
}

TEST(CorrectedOdometrySource, waits_for_odometry_of_a_clock_that_is_minutes_ahead) {
  std::vector<Frame> frames;  // at 40 Hz
  for (int i = 0; i < 20'000; ++i) frames.push_back(frame_at(25'000 * i, {0.01 * i, 0, 0}));
  for (const double delay_s : {-60.0, -300.0, 60.0}) {
    const std::vector<Frame> result = corrected(numbered(frames), 1, delay_s);
    ASSERT_EQ(result.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const double expected = std::clamp(0.01 * static_cast<double>(i) - 0.4 * delay_s, 0.0, 199.99);
      ASSERT_NEAR(result[i].odom_T_robot.x, expected, 1e-9) << delay_s << " s, frame " << i;
    }
  }
}

TEST(CorrectedOdometrySource, gives_each_laser_its_own_delay) {
  const std::vector<Frame> frames = random_run(3);
  const auto delay_s = [](std::size_t laser) { return laser == 0 ? 0.4 : -0.15; };
  CorrectedOdometrySource source(std::make_unique<FramesInMemory>(frames), 1, delay_s);
  for (const Frame& frame : frames) {
    const auto given = source.next();
    ASSERT_TRUE(given);
    EXPECT_EQ(given->time_us, frame.time_us);
    const TPose2D expected =
        interpolated(frames, frame.time_us - std::llround(1e6 * delay_s(frame.scan.laser)));
    EXPECT_NEAR(given->odom_T_robot.x, expected.x, 1e-9) << frame.index;
    EXPECT_NEAR(given->odom_T_robot.y, expected.y, 1e-9) << frame.index;
    EXPECT_NEAR(mrpt::math::wrapToPi(given->odom_T_robot.phi - expected.phi), 0, 1e-9) << frame.index;
  }
  EXPECT_FALSE(source.next());
}

TEST(CorrectedOdometrySource, scales_distances_and_keeps_turns) {
  const std::vector<Frame> frames = random_run(4);
  const std::vector<Frame> result = corrected(frames, 0.9, 0);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const TPose2D before = frames[i].odom_T_robot - frames[i - 1].odom_T_robot;
    const TPose2D after = result[i].odom_T_robot - result[i - 1].odom_T_robot;
    EXPECT_NEAR(after.x, 0.9 * before.x, 1e-9);
    EXPECT_NEAR(after.y, 0.9 * before.y, 1e-9);
    EXPECT_EQ(result[i].odom_T_robot.phi, frames[i].odom_T_robot.phi);
  }
}

TEST(CorrectedOdometrySource, interpolates_on_each_side_of_a_clock_that_was_set_back) {
  std::vector<Frame> frames;
  for (int i = 0; i < 10; ++i) frames.push_back(frame_at(100'000'000 + 100'000 * i, {1.0 * i, 0, 0}));
  for (int i = 0; i < 10; ++i) frames.push_back(frame_at(50'000'000 + 100'000 * i, {10.0 + i, 0, 0}));
  for (const double delay_s : {-0.05, 0.05}) {
    const std::vector<Frame> result = corrected(numbered(frames), 1, delay_s);
    ASSERT_EQ(result.size(), 20U);
    for (int i = 0; i < 20; ++i) {
      const double first = i < 10 ? 0 : 10;
      const double expected = std::clamp(i - 10 * delay_s, first, first + 9);
      EXPECT_NEAR(result[static_cast<std::size_t>(i)].odom_T_robot.x, expected, 1e-9) << i;
    }
  }
}

TEST(CorrectedOdometrySource, invents_no_poses_where_odometry_was_restarted) {
  std::vector<Frame> frames;
  for (int i = 0; i < 10; ++i) frames.push_back(frame_at(100'000'000 + 100'000 * i, {40 + 0.1 * i, 20, 0}));
  for (int i = 0; i < 10; ++i) frames.push_back(frame_at(130'000'000 + 100'000 * i, {0.1 * i, 0, 0}));
  for (const double delay_s : {-0.08, -0.02, 0.02, 0.08}) {
    for (const Frame& frame : corrected(numbered(frames), 1, delay_s)) {
      const TPose2D& pose = frame.odom_T_robot;
      EXPECT_TRUE((pose.x >= 40 && pose.y == 20) || (pose.x < 1 && pose.y == 0)) << pose << delay_s;
    }
  }
}

TEST(CorrectedOdometrySource, leaves_frames_without_odometry_unchanged) {
  std::vector<Frame> frames = random_run(5);
  for (std::size_t i = 0; i < frames.size(); i += 3) frames[i].has_odometry = false;
  const std::vector<Frame> result = corrected(frames, 2, -0.5);
  ASSERT_EQ(result.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(result[i].index, i);
    EXPECT_EQ(result[i].has_odometry, frames[i].has_odometry);
    if (frames[i].has_odometry) continue;
    EXPECT_EQ(result[i].odom_T_robot, frames[i].odom_T_robot);
  }
}

class DamagedLog : public FramesInMemory {
 public:
  using FramesInMemory::FramesInMemory;
  std::optional<Frame> next() override {
    std::optional<Frame> frame = FramesInMemory::next();
    if (!frame) throw UserError("damaged");
    return frame;
  }
};

TEST(CorrectedOdometrySource, throws_an_error_after_the_frames_before_it) {
  const std::vector<Frame> frames = random_run(6);
  CorrectedOdometrySource source(std::make_unique<DamagedLog>(frames), 1, [](std::size_t) { return -0.5; });
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(source.next()->index, i);
  EXPECT_THROW(source.next(), UserError);
}

}  // namespace
}  // namespace psi_slam
