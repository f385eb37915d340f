// SPDX-License-Identifier: BSD-3-Clause
// Drawing operations for a floor plan.
#pragma once

#include <vector>

#include "simulation/floor_plan.h"

namespace psi_slam {

inline constexpr double kWallThickness_m = 0.12;

/// An opening in a wall, from .. to along the wall.
struct Opening {
  double from = 0;
  double to = 0;
};

class PlanDrawing {
 public:
  explicit PlanDrawing(FloorPlan& plan) : plan_(plan) {}

  /// Outline of a box between two corners.
  void box(double x0, double y0, double x1, double y1, Material material);

  /// A wall along x at `y`, or along y at `x`, with openings sorted along the wall.
  void wall_along_x(double x0, double x1, double y, const std::vector<Opening>& openings = {});
  void wall_along_y(double y0, double y1, double x, const std::vector<Opening>& openings = {});

  void line(double x0, double y0, double x1, double y1, Material material);

  std::size_t place(double x, double y, Place::Kind kind);
  void passage(std::size_t from, std::size_t to) { plan_.passages.push_back({from, to}); }

 private:
  FloorPlan& plan_;
};

}  // namespace psi_slam
