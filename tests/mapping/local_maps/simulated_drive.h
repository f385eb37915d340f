// SPDX-License-Identifier: BSD-3-Clause
// A simulated robot: its true poses, its laser scans of a building and its odometry.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "../../matching/simulated_walls.h"
#include "psi_slam/frame.h"

namespace psi_slam {

struct SimulatedDrive {
  std::vector<Frame> frames;
  std::vector<mrpt::math::TPose2D> map_T_robot;  ///< true poses by frame; the first is the origin
};

/// Returns `count` evenly spaced bearings from first to last, both included. `count` is at least 2.
inline BeamBearings even_bearings(double first_rad, double last_rad, int count) {
  std::vector<float> bearings;
  for (int i = 0; i < count; ++i)
    bearings.push_back(static_cast<float>(first_rad + (last_rad - first_rad) * i / (count - 1)));
  return std::make_shared<const std::vector<float>>(std::move(bearings));
}

inline LaserScan simulated_scan(const SimulatedWalls& walls, const mrpt::math::TPose2D& map_T_robot,
                                const BeamBearings& bearings, const mrpt::math::TPose2D& robot_T_laser,
                                double noise_m, std::mt19937_64& random) {
  constexpr double kMaxRange_m = 30;
  std::normal_distribution<double> noise(0, 1);
  LaserScan scan;
  scan.bearings_rad = bearings;
  scan.max_range_m = static_cast<float>(kMaxRange_m);
  scan.robot_T_laser = robot_T_laser;
  const mrpt::math::TPose2D map_T_laser = map_T_robot + robot_T_laser;
  for (const float bearing : *bearings) {
    const double range = walls.range_m(map_T_laser, static_cast<double>(bearing)) + noise_m * noise(random);
    scan.ranges_m.push_back(range < kMaxRange_m ? static_cast<float>(range)
                                                : std::numeric_limits<float>::quiet_NaN());
  }
  return scan;
}

/// Errors of odometry. The factors scale the length and the rotation of every step. Each share is the
/// standard deviation of a random term that is added to the factor of each step.
struct OdometryErrors {
  double length_factor = 1;
  double turn_factor = 1;
  double length_share = 0;
  double turn_share = 0;
  double drift_rad_per_m = 0;
};

/// Simulates a robot that moves from one true pose to the next, at ten scans per second.
inline SimulatedDrive drive_along(const SimulatedWalls& walls,
                                  const std::vector<mrpt::math::TPose2D>& world_T_robot,
                                  const OdometryErrors& errors, std::uint64_t seed) {
  constexpr TimeUs kPeriod_us = 100'000;
  constexpr double kRangeNoise_m = 0.01;
  const BeamBearings bearings = even_bearings(-M_PI / 2, M_PI / 2, 181);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  SimulatedDrive result;
  mrpt::math::TPose2D odom_T_robot(0, 0, 0);
  for (std::size_t i = 0; i < world_T_robot.size(); ++i) {
    if (i > 0) {
      const mrpt::math::TPose2D motion = world_T_robot[i] - world_T_robot[i - 1];
      const double length = errors.length_factor + errors.length_share * normal(random);
      const double turn = errors.turn_factor + errors.turn_share * normal(random);
      const double drift = errors.drift_rad_per_m * std::hypot(motion.x, motion.y);
      odom_T_robot =
          odom_T_robot + mrpt::math::TPose2D(motion.x * length, motion.y * length, motion.phi * turn + drift);
    }
    Frame frame;
    frame.index = i;
    frame.time_us = 1'000'000'000 + static_cast<TimeUs>(i) * kPeriod_us;
    frame.odom_T_robot = odom_T_robot;
    frame.scan = simulated_scan(walls, world_T_robot[i], bearings, {0.1, 0, 0}, kRangeNoise_m, random);
    result.frames.push_back(std::move(frame));
    result.map_T_robot.push_back(world_T_robot[i] - world_T_robot.front());
  }
  return result;
}

/// Returns poses along straight legs between corners, `step_m` apart. At the corners, the robot turns on the
/// spot in steps of `step_rad`.
inline std::vector<mrpt::math::TPose2D> path_along(const std::vector<mrpt::math::TPoint2D>& corners,
                                                   double step_m = 0.08, double step_rad = 0.08) {
  std::vector<mrpt::math::TPose2D> path;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const double dx = corners[i + 1].x - corners[i].x;
    const double dy = corners[i + 1].y - corners[i].y;
    const double heading = std::atan2(dy, dx);
    if (!path.empty()) {
      const double from = path.back().phi;
      const double turn = std::remainder(heading - from, 2 * M_PI);
      const int steps = static_cast<int>(std::ceil(std::abs(turn) / step_rad));
      for (int k = 1; k <= steps; ++k)
        path.emplace_back(corners[i].x, corners[i].y, std::remainder(from + turn * k / steps, 2 * M_PI));
    }
    const int steps = static_cast<int>(std::ceil(std::hypot(dx, dy) / step_m));
    for (int k = path.empty() ? 0 : 1; k <= steps; ++k)
      path.emplace_back(corners[i].x + dx * k / steps, corners[i].y + dy * k / steps, heading);
  }
  return path;
}

/// A floor of 20 m x 14 m: a corridor around a block of rooms, with doorways, pillars and cupboards.
inline SimulatedWalls office_floor() {
  SimulatedWalls floor;
  floor.add_box(0, 0, 20, 14);
  floor.add_box(3, 3, 17, 11);
  for (const double x : {2.0, 5.5, 9.0, 14.0, 18.0}) {
    floor.add_box(x, 0, x + 0.6, 0.4);
    floor.add_box(x - 0.7, 13.7, x - 0.2, 14);
  }
  for (const double y : {3.5, 6.0, 10.5}) {
    floor.add_box(0, y, 0.3, y + 0.8);
    floor.add_box(19.7, y - 0.9, 20, y - 0.2);
  }
  for (const double x : {5.0, 8.3, 12.6}) {
    floor.add_box(x, 2.85, x + 0.15, 3);
    floor.add_box(x + 1.1, 11, x + 1.3, 11.2);
  }
  floor.add_box(2.8, 5.2, 3, 5.5);
  floor.add_box(17, 7.7, 17.2, 8.2);
  return floor;
}

/// One lap around the corridor of the office floor.
inline std::vector<mrpt::math::TPose2D> round_the_office() {
  return path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}});
}

}  // namespace psi_slam
