// SPDX-License-Identifier: BSD-3-Clause
// Simulates a robot with a laser in a furnished room, for tests that need the true poses.
#pragma once

#include <mrpt/core/bits_math.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "logs/frames/laser_readings.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/frame.h"

namespace psi_slam {

struct Wall {
  double x1, y1, x2, y2;
};

inline void add_box(std::vector<Wall>& walls, double x1, double y1, double x2, double y2) {
  walls.push_back({x1, y1, x2, y1});
  walls.push_back({x2, y1, x2, y2});
  walls.push_back({x2, y2, x1, y2});
  walls.push_back({x1, y2, x1, y1});
}

/// Walls of a room of 12 m by 9 m, with a block in its middle and furniture along its walls.
inline std::vector<Wall> furnished_room() {
  std::vector<Wall> walls;
  add_box(walls, 0, 0, 12, 9);
  add_box(walls, 4, 3.5, 8, 5.5);
  add_box(walls, 0, 3, 0.7, 4.2);
  add_box(walls, 2.5, 8.4, 4.1, 9);
  add_box(walls, 11.2, 6, 12, 7.5);
  add_box(walls, 6, 0, 7, 0.5);
  add_box(walls, 9.5, 0, 9.8, 0.9);
  walls.push_back({0, 7.5, 1.2, 9});
  walls.push_back({12, 1.5, 10.9, 0});
  return walls;
}

/// Distance along the ray to the nearest wall, metres. The room must be closed.
inline double range_m(const std::vector<Wall>& walls, const mrpt::math::TPose2D& ray) {
  const double dx = std::cos(ray.phi);
  const double dy = std::sin(ray.phi);
  double nearest = 1e3;
  for (const Wall& wall : walls) {
    const double ex = wall.x2 - wall.x1;
    const double ey = wall.y2 - wall.y1;
    const double cross = dx * ey - dy * ex;
    if (std::abs(cross) < 1e-12) continue;
    const double ax = wall.x1 - ray.x;
    const double ay = wall.y1 - ray.y;
    const double along_ray = (ax * ey - ay * ex) / cross;
    const double along_wall = (ax * dy - ay * dx) / cross;
    if (along_ray > 1e-9 && along_wall >= 0 && along_wall <= 1) nearest = std::min(nearest, along_ray);
  }
  return nearest;
}

/// True poses of a robot, its odometry and its scans.
struct SimulatedRun {
  static constexpr double kPeriod_s = 0.2;  ///< time between scans

  std::vector<mrpt::math::TPose2D> truth;
  std::vector<mrpt::math::TPose2D> odometry;
  std::vector<float> bearings_rad = make_bearings_rad(BeamAngles::kLeftOpen, 180, M_PI);  ///< true bearings
  mrpt::math::TPose2D robot_T_laser{0, 0, 0};
  std::vector<Wall> walls = furnished_room();
  double noise_m = 0.005;
  unsigned seed = 1;
  void (*put_into)(std::vector<float>& ranges_m, std::size_t scan) = nullptr;  ///< changes each scan

  std::vector<float> ranges_m(std::size_t i) const {
    std::mt19937 random(seed * 100'003U + static_cast<unsigned>(i));
    std::normal_distribution<double> noise(0, noise_m);
    const mrpt::math::TPose2D laser = truth[i] + robot_T_laser;
    std::vector<float> ranges;
    for (const float bearing : bearings_rad)
      ranges.push_back(static_cast<float>(
          range_m(walls, laser + mrpt::math::TPose2D{0, 0, static_cast<double>(bearing)}) + noise(random)));
    if (put_into != nullptr) put_into(ranges, i);
    return ranges;
  }

  LaserScan scan(std::size_t i) const {
    LaserScan scan;
    scan.ranges_m = ranges_m(i);
    scan.bearings_rad = std::make_shared<const std::vector<float>>(bearings_rad);
    scan.robot_T_laser = robot_T_laser;
    scan.max_range_m = 50;
    return scan;
  }
};

/// Consecutive equal steps of a run.
struct RunPart {
  double ahead_m;   // distance of each step; negative: reversing
  double turn_deg;  // rotation of each step, counterclockwise
  std::size_t steps;
};

/// Simulates a run. The error of its odometry is 2 % of each step (standard deviation) plus a heading drift
/// of 0.004 rad/m.
inline SimulatedRun simulated_run(const std::vector<RunPart>& parts,
                                  const mrpt::math::TPose2D& start = {2, 1.8, 0}, unsigned seed = 7) {
  SimulatedRun run;
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, 0.02);
  run.truth.push_back(start);
  run.odometry.push_back({0, 0, 0});
  for (const RunPart& part : parts) {
    for (std::size_t i = 0; i < part.steps; ++i) {
      const double turn_rad = mrpt::DEG2RAD(part.turn_deg);
      run.truth.push_back(run.truth.back() + mrpt::math::TPose2D{part.ahead_m, 0, turn_rad});
      run.odometry.push_back(run.odometry.back() + mrpt::math::TPose2D{part.ahead_m * (1 + error(random)), 0,
                                                                       turn_rad * (1 + error(random)) +
                                                                           0.004 * std::abs(part.ahead_m)});
    }
  }
  return run;
}

/// Returns one counter-clockwise lap around the block in the room. It starts with a full turn on the spot,
/// turns by 90 degrees at each corner, and reverses by 0.5 m once.
inline std::vector<RunPart> round_trip() {
  const RunPart corner{0.0, 3.0, 30};
  return {{0.0, -4.0, 90},  {0.08, 0.0, 95}, corner,          {0.08, 0.2, 10},
          {0.08, -0.1, 20}, {0.08, 0.0, 30}, corner,          {-0.05, 0.0, 10},
          {0.08, 0.0, 101}, corner,          {0.08, 0.0, 60}, corner};
}

inline SimulatedRun round_trips(std::size_t count, unsigned seed = 7) {
  std::vector<RunPart> parts;
  for (std::size_t i = 0; i < count; ++i)
    for (const RunPart& part : round_trip()) parts.push_back(part);
  return simulated_run(parts, {2, 1.8, 0}, seed);
}

/// Returns the run with scans that were measured `delay_s` before their time stamps.
inline SimulatedRun with_late_stamps(SimulatedRun run, double delay_s) {
  const std::vector<mrpt::math::TPose2D> truth = run.truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double at = std::clamp(static_cast<double>(i) - delay_s / SimulatedRun::kPeriod_s, 0.0,
                                 static_cast<double>(truth.size() - 1));
    const auto before = std::min(static_cast<std::size_t>(at), truth.size() - 2);
    run.truth[i] = interpolate(truth[before], truth[before + 1], at - static_cast<double>(before));
  }
  return run;
}

/// CARMEN log of the run, with a FLASER line every 0.2 s.
inline std::string carmen_log(const SimulatedRun& run) {
  std::string log = "# simulated\n";
  char text[200];
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    log += "FLASER " + std::to_string(run.bearings_rad.size());
    for (const float range : run.ranges_m(i)) {
      std::snprintf(text, sizeof text, " %.3f", static_cast<double>(range));
      log += text;
    }
    const mrpt::math::TPose2D& pose = run.odometry[i];
    for (int twice = 0; twice < 2; ++twice) {
      std::snprintf(text, sizeof text, " %.6f %.6f %.6f", pose.x, pose.y, pose.phi);
      log += text;
    }
    std::snprintf(text, sizeof text, " %.6f host 0\n",
                  1000 + SimulatedRun::kPeriod_s * static_cast<double>(i));
    log += text;
  }
  return log;
}

}  // namespace psi_slam
