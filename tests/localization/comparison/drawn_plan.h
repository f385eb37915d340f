// SPDX-License-Identifier: BSD-3-Clause
// Grid maps of a small building, drawn in any frame, for the tests of comparisons.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "logs/frames/pose_operations.h"

namespace psi_slam {

using PlanWall = std::pair<mrpt::math::TPoint2D, mrpt::math::TPoint2D>;

/// A building: its area is free but for the walls, and everything outside is unknown. Metres.
struct DrawnPlan {
  double width_m = 12;
  double height_m = 8;
  /// Four outer walls, two rooms, a corridor and two pieces of furniture, without any symmetry.
  std::vector<PlanWall> walls{{{0, 0}, {12, 0}},    {{12, 0}, {12, 8}},    {{12, 8}, {0, 8}},
                              {{0, 8}, {0, 0}},     {{5, 0}, {5, 3}},      {{5, 4}, {5, 8}},
                              {{5, 4.5}, {8, 4.5}}, {{9, 4.5}, {12, 4.5}}, {{1, 6}, {2.5, 6}},
                              {{2.5, 6}, {2.5, 7}}, {{9.5, 1}, {11, 1.7}}};
  /// Left of this line, nothing is known.
  double seen_from_x_m = -1;

  bool is_wall(const mrpt::math::TPoint2D& point, double half_width_m) const {
    return std::any_of(walls.begin(), walls.end(), [&](const PlanWall& wall) {
      const auto along = wall.second - wall.first;
      const auto to = point - wall.first;
      const double share = std::clamp((to.x * along.x + to.y * along.y) / along.sqrNorm(), 0.0, 1.0);
      return (to - along * share).norm() <= half_width_m;
    });
  }
};

/// Draws the plan as a grid map whose frame has the pose `plan_T_map`.
inline mrpt::maps::COccupancyGridMap2D map_of(const DrawnPlan& plan,
                                              const mrpt::math::TPose2D& plan_T_map = {0, 0, 0},
                                              float cell_m = 0.05F) {
  const auto map_T_plan = inverse(plan_T_map);
  double x_min = 1e9;
  double x_max = -1e9;
  double y_min = 1e9;
  double y_max = -1e9;
  for (const double x : {0.0, plan.width_m}) {
    for (const double y : {0.0, plan.height_m}) {
      const auto corner = map_T_plan.composePoint({x, y});
      x_min = std::min(x_min, corner.x - 0.5);
      x_max = std::max(x_max, corner.x + 0.5);
      y_min = std::min(y_min, corner.y - 0.5);
      y_max = std::max(y_max, corner.y + 0.5);
    }
  }
  mrpt::maps::COccupancyGridMap2D map;
  map.setSize(static_cast<float>(x_min), static_cast<float>(x_max), static_cast<float>(y_min),
              static_cast<float>(y_max), cell_m, 0.5F);
  for (unsigned row = 0; row < map.getSizeY(); ++row) {
    for (unsigned column = 0; column < map.getSizeX(); ++column) {
      const auto point = plan_T_map.composePoint(
          {static_cast<double>(map.idx2x(column)), static_cast<double>(map.idx2y(row))});
      if (point.x < plan.seen_from_x_m) continue;
      const bool inside = point.x > 0 && point.x < plan.width_m && point.y > 0 && point.y < plan.height_m;
      const bool wall = plan.is_wall(point, 0.6 * static_cast<double>(cell_m));
      if (inside || wall) map.setCell(static_cast<int>(column), static_cast<int>(row), wall ? 0.02F : 0.98F);
    }
  }
  return map;
}

}  // namespace psi_slam
