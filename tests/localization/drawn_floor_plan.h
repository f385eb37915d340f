// SPDX-License-Identifier: BSD-3-Clause
// The floor plan of a simulated building as an architect draws it: walls without furniture.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulated_runs.h"
#include "simulation/floor_plan.h"

namespace psi_slam {

/// Draws lines of walls into free space, with a margin of 1 m around them.
inline mrpt::maps::COccupancyGridMap2D drawn_walls(const std::vector<PlanSegment>& segments) {
  constexpr double kMargin_m = 1;
  constexpr double kStep_m = 0.02;
  double x_min = std::numeric_limits<double>::infinity();
  double y_min = x_min;
  double x_max = -x_min;
  double y_max = -x_min;
  for (const PlanSegment& segment : segments)
    for (const auto& end : {segment.from, segment.to}) {
      x_min = std::min(x_min, end.x);
      y_min = std::min(y_min, end.y);
      x_max = std::max(x_max, end.x);
      y_max = std::max(y_max, end.y);
    }
  mrpt::maps::COccupancyGridMap2D grid;
  grid.setSize(static_cast<float>(x_min - kMargin_m), static_cast<float>(x_max + kMargin_m),
               static_cast<float>(y_min - kMargin_m), static_cast<float>(y_max + kMargin_m), 0.05F, 0.99F);
  for (const PlanSegment& segment : segments) {
    const auto along = segment.to - segment.from;
    const int steps = static_cast<int>(std::ceil(std::hypot(along.x, along.y) / kStep_m));
    for (int i = 0; i <= steps; ++i) {
      const auto at = segment.from + along * (static_cast<double>(i) / std::max(steps, 1));
      grid.setCell(grid.x2idx(at.x), grid.y2idx(at.y), 0.01F);
    }
  }
  return grid;
}

/// Walls of the building that run_through(plan, ...) maps, without its furniture.
inline std::vector<PlanSegment> building_walls(std::uint64_t plan) {
  std::vector<PlanSegment> walls = draw_floor_plan(plan_options(plan)).segments;
  walls.erase(std::remove_if(walls.begin(), walls.end(),
                             [](const PlanSegment& one) { return one.material == Material::kFurniture; }),
              walls.end());
  return walls;
}

inline mrpt::maps::COccupancyGridMap2D drawn_floor_plan(std::uint64_t plan) {
  return drawn_walls(building_walls(plan));
}

}  // namespace psi_slam
