// SPDX-License-Identifier: BSD-3-Clause
#include "localization/clear_beams.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

constexpr int kWallScore = 160;           // of 255: inside a wall, not beside it
constexpr double kSurface_m = 0.25;       // walls this near to the end of a beam are the surface it hit
constexpr double kLeastIncidence = 0.05;  // sine of the angle between beam and wall
constexpr double kNoSurface = 0.5;        // incidence if the surface normal is unknown

/// Length of the last part of a beam that may lie on a wall.
double tolerance_m(const ScanPoints& scan, std::size_t i, double dx, double dy) {
  double incidence = kNoSurface;
  if (!scan.normals.empty() && (scan.normals[i].x != 0 || scan.normals[i].y != 0))
    incidence =
        std::abs(dx * static_cast<double>(scan.normals[i].x) + dy * static_cast<double>(scan.normals[i].y));
  return kSurface_m / std::max(incidence, kLeastIncidence);
}

}  // namespace

ClearBeams clear_beams(const ScoreGrid& map, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot) {
  ClearBeams result;
  const double cells_per_m = 1 / map.resolution_m();
  const double c = std::cos(map_T_robot.phi);
  const double s = std::sin(map_T_robot.phi);
  for_each_laser(scan, [&](const mrpt::math::TPoint2Df& origin, std::size_t first, std::size_t last) {
    const auto origin_x = static_cast<double>(origin.x);
    const auto origin_y = static_cast<double>(origin.y);
    const double x0 = (map_T_robot.x + c * origin_x - s * origin_y - map.origin_x_m()) * cells_per_m;
    const double y0 = (map_T_robot.y + s * origin_x + c * origin_y - map.origin_y_m()) * cells_per_m;
    for (std::size_t i = first; i < last; ++i) {
      const double bx = static_cast<double>(scan.points[i].x) - origin_x;
      const double by = static_cast<double>(scan.points[i].y) - origin_y;
      const double range_m = std::hypot(bx, by);
      if (range_m <= 0) continue;
      const double dx = bx / range_m;
      const double dy = by / range_m;
      const double step_x = c * dx - s * dy;
      const double step_y = s * dx + c * dy;
      const double end = (range_m - tolerance_m(scan, i, dx, dy)) * cells_per_m;
      bool clear = true;
      for (double t = 0; t < end && clear; t += 1)
        clear = map.finest().at(floor_to_int(x0 + t * step_x), floor_to_int(y0 + t * step_y)) < kWallScore;
      ++result.beams;
      if (clear) ++result.clear;
    }
  });
  return result;
}

}  // namespace psi_slam
