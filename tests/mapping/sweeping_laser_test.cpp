// SPDX-License-Identifier: BSD-3-Clause
// Maps a laser of 5.5 Hz that is carried through a room without odometry. Each sweep takes the whole time
// between two scans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "psi_slam/mapper.h"
#include "simulated_run.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kPeriod_s = 1 / 5.5;
constexpr std::size_t kScans = 260;

/// Pose in the room of a person who walks around the block and sways by up to 1 rad/s.
TPose2D world_T_robot(double time_s) {
  const double turn = 2 * M_PI * time_s / 40;
  return {6 + 3.6 * std::cos(turn), 4.5 + 2.6 * std::sin(turn),
          mrpt::math::wrapToPi(turn + M_PI / 2 + 0.6 * std::sin(1.4 * time_s))};
}

/// Scans of the walk. `direction` is 1 if the first beam is measured first, -1 if the last is.
std::vector<Frame> walk(double direction) {
  const std::vector<Wall> walls = furnished_room();
  const auto bearings =
      std::make_shared<const std::vector<float>>(make_bearings_rad(BeamAngles::kLeftOpen, 360, 2 * M_PI));
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<Frame> frames;
  for (std::size_t k = 0; k < kScans; ++k) {
    const double start_s = kPeriod_s * static_cast<double>(k);
    Frame frame;
    frame.index = k;
    frame.time_us = static_cast<TimeUs>(1e15 + 1e6 * start_s);
    frame.has_odometry = false;
    frame.scan.bearings_rad = bearings;
    frame.scan.max_range_m = 12;
    frame.scan.sweep_time_s = static_cast<float>(direction * kPeriod_s);
    for (std::size_t i = 0; i < bearings->size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(bearings->size() - 1);
      const TPose2D pose = world_T_robot(start_s + kPeriod_s * (direction > 0 ? share : 1 - share));
      frame.scan.ranges_m.push_back(static_cast<float>(
          range_m(walls, pose + TPose2D{0, 0, static_cast<double>((*bearings)[i])}) + noise(random)));
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

struct Errors {
  double mean_m = 0;
  double mean_rad = 0;
};

/// Mean errors of the poses relative to the tenth scan, the first whose velocity is known well.
Errors errors_of(const std::vector<Frame>& frames) {
  constexpr std::size_t kFirst = 10;
  Mapper mapper;
  for (const Frame& frame : frames) mapper.add(frame);
  const MappingResult result = mapper.finish();
  Errors errors;
  for (std::size_t k = kFirst; k < kScans; ++k) {
    const TPose2D found = result.frames[k].map_T_robot - result.frames[kFirst].map_T_robot;
    const TPose2D truth = world_T_robot(kPeriod_s * static_cast<double>(k)) -
                          world_T_robot(kPeriod_s * static_cast<double>(kFirst));
    const TPose2D off = found - truth;
    errors.mean_m += std::hypot(off.x, off.y) / static_cast<double>(kScans - kFirst);
    errors.mean_rad += std::abs(off.phi) / static_cast<double>(kScans - kFirst);
  }
  return errors;
}

class SweepingLaser : public testing::TestWithParam<double> {};

TEST_P(SweepingLaser, is_mapped_as_if_it_had_stood_still) {
  const std::vector<Frame> frames = walk(GetParam());
  std::vector<Frame> bent = frames;
  for (Frame& frame : bent) frame.scan.sweep_time_s = 0;
  const Errors straight = errors_of(frames);
  const Errors unknown = errors_of(bent);
  RecordProperty("straightened_mm", std::to_string(1e3 * straight.mean_m));
  RecordProperty("straightened_mrad", std::to_string(1e3 * straight.mean_rad));
  RecordProperty("bent_mm", std::to_string(1e3 * unknown.mean_m));
  RecordProperty("bent_mrad", std::to_string(1e3 * unknown.mean_rad));
  EXPECT_LT(straight.mean_m, 0.03);
  EXPECT_LT(straight.mean_rad, 0.01);
  EXPECT_LT(straight.mean_rad, 0.3 * unknown.mean_rad);
}

INSTANTIATE_TEST_SUITE_P(Directions, SweepingLaser, testing::Values(1.0, -1.0), [](const auto& tested) {
  return tested.param > 0 ? "first_beam_first" : "last_beam_first";
});

}  // namespace
}  // namespace psi_slam
