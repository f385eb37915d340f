// SPDX-License-Identifier: BSD-3-Clause
// Score grids, scans and windows for the tests of matching: random grids and points, and ideal grids and
// scans of walls.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "matching/scan_points.h"
#include "matching/score_grid.h"
#include "matching/search_window.h"
#include "simulated_walls.h"

namespace psi_slam {

/// Makes a grid of random cells with `levels` different scores from 0 to 255. Few levels give many ties.
inline ScoreGrid random_grid(std::mt19937_64& random, int width, int height, int levels) {
  std::uniform_real_distribution<double> place(-2, 2);
  ScoreGrid grid(place(random), place(random), 0.05, width, height);
  std::uniform_int_distribution<int> level(0, levels - 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      *grid.finest().cell(x, y) = static_cast<std::uint8_t>(level(random) * 255 / (levels - 1));
  grid.build_pyramid();
  return grid;
}

/// Makes random points around the robot, at most `reach_m` away along each axis.
inline ScanPoints random_points(std::mt19937_64& random, std::size_t count, double reach_m) {
  std::uniform_real_distribution<float> coordinate(-static_cast<float>(reach_m), static_cast<float>(reach_m));
  ScanPoints scan;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = coordinate(random);
    const float y = coordinate(random);
    scan.points.emplace_back(x, y);
    scan.farthest_m = std::max(scan.farthest_m, std::hypot(static_cast<double>(x), static_cast<double>(y)));
  }
  return scan;
}

/// Makes a window with the given numbers of steps to each side of the centre, and cells of 0.05 m.
inline SearchWindow window_of_steps(int n_x, int n_y, int n_theta, double angular_step_rad) {
  SearchWindow window;
  window.linear_step_m = 0.05;
  window.angular_step_rad = angular_step_rad;
  window.n_x = n_x;
  window.n_y = n_y;
  window.n_theta = n_theta;
  return window;
}

/// Makes an ideal score grid of walls: each score is a Gaussian of the distance to the nearest wall.
inline ScoreGrid grid_of(const SimulatedWalls& walls, double margin_m = 1.0, double sigma_m = 0.05) {
  constexpr double kResolution_m = 0.05;
  const auto box = walls.bounding_box();
  const auto cells = [&](double extent_m) {
    return static_cast<int>(std::ceil((extent_m + 2 * margin_m) / kResolution_m));
  };
  ScoreGrid grid(box.x_min - margin_m, box.y_min - margin_m, kResolution_m, cells(box.x_max - box.x_min),
                 cells(box.y_max - box.y_min));
  for (int y = 0; y < grid.finest().height(); ++y) {
    for (int x = 0; x < grid.finest().width(); ++x) {
      const double d = walls.distance_m(grid.origin_x_m() + (x + 0.5) * kResolution_m,
                                        grid.origin_y_m() + (y + 0.5) * kResolution_m);
      *grid.finest().cell(x, y) =
          static_cast<std::uint8_t>(std::lround(255 * std::exp(-0.5 * d * d / (sigma_m * sigma_m))));
    }
  }
  grid.build_pyramid();
  return grid;
}

/// Simulates a scan of walls by a laser at the robot's centre, over 360 degrees. Each beam gives one point.
inline ScanPoints scan_of(const SimulatedWalls& walls, const mrpt::math::TPose2D& map_T_robot, int beams,
                          double noise_m, std::mt19937_64& random) {
  std::normal_distribution<double> noise(0, 1);
  ScanPoints scan;
  for (int i = 0; i < beams; ++i) {
    const double bearing = 2 * M_PI * i / beams;
    const double range = walls.range_m(map_T_robot, bearing) + noise_m * noise(random);
    if (!std::isfinite(range)) continue;
    scan.points.emplace_back(static_cast<float>(range * std::cos(bearing)),
                             static_cast<float>(range * std::sin(bearing)));
    scan.farthest_m = std::max(scan.farthest_m, range);
  }
  return scan;
}

}  // namespace psi_slam
