// SPDX-License-Identifier: BSD-3-Clause
// Maps a simulated run with a front and a rear laser of 180 degrees each, which scan at different times.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "psi_slam/mapper.h"
#include "simulation/simulated_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct Drive {
  std::vector<Frame> frames;
  std::vector<TPose2D> start_T_robot;  // true poses relative to the first scan
};

const Drive& drive() {
  static const Drive made = [] {
    SimulatedLogOptions options = simulated_log_options(45, 3);
    options.scan.robot_T_laser = {0.3, 0, 0};
    FurtherLaser rear;
    rear.scan = options.scan;
    rear.scan.seed = 17;
    rear.scan.robot_T_laser = {-0.3, 0, M_PI};
    rear.delay_s = 0.06;
    options.further_lasers = {rear};
    SimulatedLog log(options);
    Drive drive;
    TPose2D start;
    while (auto frame = log.next()) {
      if (frame->index == 0) start = log.world_T_robot();
      drive.frames.push_back(*std::move(frame));
      drive.start_T_robot.push_back(log.world_T_robot() - start);
    }
    return drive;
  }();
  return made;
}

struct Errors {
  double mean_m = 0;
  double mean_rad = 0;
};

/// Mean errors of the mapped motion over 20 scans, which do not depend on the origin of the map.
Errors errors_of(const std::vector<Frame>& frames) {
  Mapper mapper;
  for (const Frame& frame : frames) mapper.add(frame);
  const MappingResult result = mapper.finish();
  Errors errors;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i + 20 < frames.size(); i += 5, ++pairs) {
    const TPose2D found = result.frames[i + 20].map_T_robot - result.frames[i].map_T_robot;
    const TPose2D truth = drive().start_T_robot[i + 20] - drive().start_T_robot[i];
    const TPose2D off = found - truth;
    errors.mean_m += std::hypot(off.x, off.y);
    errors.mean_rad += std::abs(off.phi);
  }
  errors.mean_m /= static_cast<double>(pairs);
  errors.mean_rad /= static_cast<double>(pairs);
  return errors;
}

TEST(TwoLasers, map_at_least_as_well_as_one) {
  std::vector<Frame> front = drive().frames;
  for (Frame& frame : front) frame.companions.clear();
  std::vector<Frame> unmoved = drive().frames;
  for (Frame& frame : unmoved) frame.companions[0].frame_T_robot = {};
  const Errors both = errors_of(drive().frames);
  const Errors one = errors_of(front);
  const Errors wrong = errors_of(unmoved);
  RecordProperty("both_mm", std::to_string(both.mean_m * 1e3));
  RecordProperty("front_mm", std::to_string(one.mean_m * 1e3));
  RecordProperty("unmoved_mm", std::to_string(wrong.mean_m * 1e3));
  EXPECT_LE(both.mean_m, one.mean_m);
  EXPECT_LE(both.mean_rad, one.mean_rad);
  EXPECT_LT(both.mean_m, 0.02);
  EXPECT_LT(both.mean_m, wrong.mean_m) << "odometry places the scans of the second laser";
}

TEST(TwoLasers, mapping_continues_while_one_is_silent) {
  std::vector<Frame> frames = drive().frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % 90 < 30) continue;
    if (i % 90 < 60) {
      frames[i].companions.clear();
    } else {  // the rear laser alone, as ScanSynchronizer passes it on
      CompanionScan rear = frames[i].companions[0];
      frames[i].companions.clear();
      frames[i].scan = rear.scan;
      frames[i].time_us = rear.time_us;
      frames[i].odom_T_robot = frames[i].odom_T_robot + rear.frame_T_robot;
    }
  }
  Mapper mapper;
  for (const Frame& frame : frames) mapper.add(frame);
  const MappingResult result = mapper.finish();
  double worst_m = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % 90 >= 60) continue;  // the true pose belongs to the time of the first laser
    const TPose2D off = result.frames[i].map_T_robot - drive().start_T_robot[i];
    worst_m = std::max(worst_m, std::hypot(off.x, off.y));
  }
  EXPECT_LT(worst_m, 0.15);
}

}  // namespace
}  // namespace psi_slam
