// SPDX-License-Identifier: BSD-3-Clause
// Simple, slow geometry of floor plans as a reference for the simulation.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/floor_plan.h"

namespace psi_slam {

inline double cross(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b) {
  return a.x * b.y - a.y * b.x;
}

inline bool cross_each_other(const mrpt::math::TPoint2D& a, const mrpt::math::TPoint2D& b,
                             const PlanSegment& wall) {
  const double from = cross(b - a, wall.from - a);
  const double to = cross(b - a, wall.to - a);
  const double first = cross(wall.to - wall.from, a - wall.from);
  const double second = cross(wall.to - wall.from, b - wall.from);
  return from * to < 0 && first * second < 0;
}

inline double distance_m(const mrpt::math::TPoint2D& point, const PlanSegment& wall) {
  const mrpt::math::TPoint2D way = wall.to - wall.from;
  const mrpt::math::TPoint2D off = point - wall.from;
  const double length2 = way.x * way.x + way.y * way.y;
  const double share = length2 > 0 ? std::clamp((off.x * way.x + off.y * way.y) / length2, 0.0, 1.0) : 0;
  return std::hypot(off.x - share * way.x, off.y - share * way.y);
}

/// Distance of a point to the nearest segment, in metres. Infinite if the plan has no segments.
inline double clearance_m(const FloorPlan& plan, const mrpt::math::TPoint2D& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const PlanSegment& wall : plan.segments) nearest = std::min(nearest, distance_m(point, wall));
  return nearest;
}

/// Distance in metres along a ray to the first segment. With `pass_glass`, the ray passes glass. Infinite if
/// the ray hits nothing.
inline double ray_m(const FloorPlan& plan, const mrpt::math::TPose2D& ray, bool pass_glass) {
  const mrpt::math::TPoint2D direction(std::cos(ray.phi), std::sin(ray.phi));
  double nearest = std::numeric_limits<double>::infinity();
  for (const PlanSegment& wall : plan.segments) {
    if (pass_glass && wall.material == Material::kGlass) continue;
    const mrpt::math::TPoint2D way = wall.to - wall.from;
    const double determinant = cross(direction, way);
    if (std::abs(determinant) < 1e-12) continue;
    const mrpt::math::TPoint2D off(wall.from.x - ray.x, wall.from.y - ray.y);
    const double range = cross(off, way) / determinant;
    const double share = cross(off, direction) / determinant;
    if (range > 0 && share >= 0 && share <= 1) nearest = std::min(nearest, range);
  }
  return nearest;
}

}  // namespace psi_slam
