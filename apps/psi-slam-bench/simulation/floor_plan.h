// SPDX-License-Identifier: BSD-3-Clause
// A random floor of a building. Crossing corridors form rings; some stretches have no doors. Between the
// corridors lie blocks of rooms with doors and furniture, and halls with pillars. Some walls are of glass.
// Walls are line segments in metres. Free paths form a graph of places and passages.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace psi_slam {

enum class Material { kWall, kGlass, kPillar, kFurniture };

struct PlanSegment {
  mrpt::math::TPoint2D from;
  mrpt::math::TPoint2D to;
  Material material = Material::kWall;
};

/// A point where a robot can stand.
struct Place {
  enum class Kind { kCrossing, kCorridor, kRoom };
  mrpt::math::TPoint2D at;
  Kind kind = Kind::kCrossing;
};

/// A straight free path, usable in both directions, between two places given by their indices in
/// FloorPlan::places.
struct Passage {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// Centre line and width of a corridor that crosses the whole building.
struct Corridor {
  mrpt::math::TPoint2D from;
  mrpt::math::TPoint2D to;
  double width_m = 0;
};

struct FloorPlan {
  std::vector<PlanSegment> segments;
  std::vector<Place> places;
  std::vector<Passage> passages;
  std::vector<Corridor> corridors;
  std::vector<PlanSegment> doors;  ///< where closed doors of rooms would be; all doors of `segments` are open

  double corridors_m() const;  ///< total length of the corridors
  std::size_t rooms() const;   ///< number of rooms and halls
};

struct FloorPlanOptions {
  std::uint64_t seed = 1;
  double corridors_m = 150;  ///< least total length of the corridors; there is always a ring around one block
  double glass_share = 0.1;  ///< share of glass in front walls and the outer wall, in [0, 1]
  double bare_share = 0.25;  ///< share of corridor stretches that have neither doors nor furniture
  double hall_share = 0.15;  ///< share of halls among the blocks without bare corridor stretches
  double scale = 1;          ///< factor of all lengths except corridors_m, at least 1
};

/// Draws a floor plan; the same options give the same plan. Passages keep at least kPlanClearance_m from all
/// segments. Throws std::invalid_argument for a scale below 1.
FloorPlan draw_floor_plan(const FloorPlanOptions& options);

inline constexpr double kPlanClearance_m = 0.45;

}  // namespace psi_slam
