// SPDX-License-Identifier: BSD-3-Clause
// Maps a robot that stands still for long, with and without odometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "logs/frames/discarded_ranges.h"
#include "map/exports/run_summary.h"
#include "psi_slam/mapper.h"
#include "simulated_room.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kRate_hz = 40;
constexpr double kDrive_s = 4;
constexpr double kSpeed_mps = 0.5;
constexpr double kPerson_m = 0.25;  // radius

/// A robot that drives 2 m, stands, and drives 1 m back to where it came from.
struct StandingRun {
  double stand_s = 25;
  int beams = 181;
  bool has_odometry = true;
  double odometry_noise = 0;  ///< standard deviation of each step of odometry, as a share of the step
  double push_mps = 0;        ///< speed at which somebody pushes the standing robot, with its wheels blocked
  /// Place of a person in the room, by the time since the robot stopped; empty: nobody is there.
  std::function<std::optional<TPoint2D>(double standing_s)> person = [](double) { return std::nullopt; };

  std::size_t scans() const { return static_cast<std::size_t>((2 * kDrive_s + stand_s) * kRate_hz); }
  std::size_t first_after_standing() const {
    return static_cast<std::size_t>((kDrive_s + stand_s) * kRate_hz) + 1;
  }

  /// Path along the x axis of the room since the first scan, without the push.
  double wheels_m(std::size_t scan) const {
    const double time_s = static_cast<double>(scan) / kRate_hz;
    const double driven_back_s = std::max(0.0, time_s - kDrive_s - stand_s);
    return kSpeed_mps * std::min(time_s, kDrive_s) - kSpeed_mps / 2 * driven_back_s;
  }
  double standing_s(std::size_t scan) const { return static_cast<double>(scan) / kRate_hz - kDrive_s; }

  /// True pose relative to the first scan.
  TPose2D pose(std::size_t scan) const {
    return {wheels_m(scan) + push_mps * std::clamp(standing_s(scan), 0.0, stand_s), 0, 0};
  }

  static float range_of_person(const TPoint2D& person, const TPose2D& laser, double bearing) {
    const double dx = person.x - laser.x;
    const double dy = person.y - laser.y;
    const double along = std::cos(laser.phi + bearing) * dx + std::sin(laser.phi + bearing) * dy;
    const double across = std::cos(laser.phi + bearing) * dy - std::sin(laser.phi + bearing) * dx;
    if (along <= 0 || std::abs(across) >= kPerson_m) return 1000;
    return static_cast<float>(along - std::sqrt(kPerson_m * kPerson_m - across * across));
  }

  /// Calls `take` with each frame of the run.
  void drive(const std::function<void(Frame)>& take) const {
    const SimulatedRoom room{-2, 6, -2, 3};
    const TPose2D room_T_start(-1, 0.5, 0);
    const BeamBearings bearings = even_bearings(-2.3, 2.3, beams);
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, 1);
    double odometry_m = 0;
    for (std::size_t scan = 0; scan < scans(); ++scan) {
      Frame frame = room.scan_from(room_T_start + pose(scan), bearings);
      frame.index = scan;
      frame.time_us = 1'000'000'000 + static_cast<TimeUs>(scan) * static_cast<TimeUs>(1e6 / kRate_hz);
      if (scan > 0)
        odometry_m += (wheels_m(scan) - wheels_m(scan - 1)) * (1 + odometry_noise * noise(random));
      frame.odom_T_robot = {odometry_m, 0, 0};
      frame.has_odometry = has_odometry;
      const auto there = person(standing_s(scan));
      const TPose2D laser = room_T_start + pose(scan) + frame.scan.robot_T_laser;
      for (std::size_t i = 0; i < bearings->size(); ++i) {
        float& range = frame.scan.ranges_m[i];
        if (there)
          range = std::min(range, range_of_person(*there, laser, static_cast<double>((*bearings)[i])));
        range += static_cast<float>(0.01 * noise(random));
      }
      take(std::move(frame));
    }
  }
};

MappingResult mapped(const StandingRun& run) {
  Mapper mapper;
  run.drive([&](Frame frame) { mapper.add(std::move(frame)); });
  return mapper.finish();
}

std::size_t kept_scans(const MappingResult& result) {
  return static_cast<std::size_t>(std::count_if(result.log.begin(), result.log.end(), has_ranges));
}

/// Difference of a mapped pose from the true one along the path.
double error_m(const StandingRun& run, const MappingResult& result, std::size_t scan) {
  return result.frames[scan].map_T_robot.x - run.pose(scan).x;
}

double largest_error_m(const StandingRun& run, const MappingResult& result) {
  double largest = 0;
  for (std::size_t scan = 0; scan < run.scans(); ++scan)
    largest = std::max(largest, std::abs(error_m(run, result, scan)));
  return largest;
}

/// Mean error of the first ten scans after the robot drove off.
double lag_m(const StandingRun& run, const MappingResult& result) {
  double lag = 0;
  for (std::size_t scan = 0; scan < 10; ++scan)
    lag += error_m(run, result, run.first_after_standing() + scan) / 10;
  return std::abs(lag);
}

StandingRun without_odometry() {
  StandingRun run;
  run.has_odometry = false;
  return run;
}

StandingRun with_noisy_odometry() {
  StandingRun run;
  run.odometry_noise = 0.3;
  return run;
}

TEST(StandingRobot, keeps_all_poses_but_few_scans) {
  for (const StandingRun& run : {with_noisy_odometry(), without_odometry()}) {
    const MappingResult result = mapped(run);
    ASSERT_EQ(result.frames.size(), run.scans());
    ASSERT_EQ(result.log.size(), run.scans());
    EXPECT_LT(kept_scans(result), 18 * kRate_hz + 100) << "8 s of driving, 10 s of standing, and few more";
    EXPECT_GT(kept_scans(result), 18 * kRate_hz);
    EXPECT_LT(largest_error_m(run, result), 0.02);
    EXPECT_LT(lag_m(run, result), 0.005);
    for (const FrameRecord& frame : result.frames) EXPECT_NE(frame.match, ScanMatch::kUnmatched);
  }
}

TEST(StandingRobot, a_recording_of_the_kept_scans_gives_the_same_poses) {
  for (StandingRun run : {with_noisy_odometry(), without_odometry()}) {
    run.person = [](double standing_s) -> std::optional<TPoint2D> {
      if (standing_s < 12 || standing_s > 22) return std::nullopt;
      return TPoint2D(2, -1 + 0.1 * (standing_s - 12));
    };
    const MappingResult first = mapped(run);
    ASSERT_LT(kept_scans(first), run.scans() - 100);
    Mapper again;
    for (const Frame& frame : first.log) again.add(frame);
    const MappingResult second = again.finish();
    for (std::size_t i = 0; i < first.frames.size(); ++i) {
      ASSERT_EQ(first.frames[i].map_T_robot, second.frames[i].map_T_robot) << i;
      ASSERT_EQ(first.frames[i].response, second.frames[i].response) << i;
      ASSERT_EQ(first.log[i].scan.ranges_m, second.log[i].scan.ranges_m) << i;
    }
  }
}

TEST(StandingRobot, short_stops_discard_nothing) {
  StandingRun run;
  run.stand_s = 9;
  EXPECT_EQ(kept_scans(mapped(run)), run.scans());
}

TEST(StandingRobot, is_followed_if_it_is_pushed) {
  for (StandingRun run : {StandingRun(), without_odometry()}) {
    run.push_mps = 0.01;
    const MappingResult result = mapped(run);
    EXPECT_LT(largest_error_m(run, result), 0.03) << "it was pushed by 0.25 m";
  }
}

TEST(StandingRobot, for_hours_takes_little_memory) {
  const char* hours = std::getenv("PSI_SLAM_STANDING_HOURS");
  if (hours == nullptr) GTEST_SKIP() << "takes minutes: set PSI_SLAM_STANDING_HOURS to a number, such as 10";
  StandingRun run;
  run.beams = 1081;
  run.stand_s = 3600 * std::stod(hours);
  const MappingResult result = mapped(run);
  EXPECT_EQ(result.frames.size(), run.scans());
  RecordProperty("kept_scans", std::to_string(kept_scans(result)));
  RecordProperty("memory_mib", std::to_string(peak_memory_mib()));
  EXPECT_LT(peak_memory_mib(), 2048);
}

}  // namespace
}  // namespace psi_slam
