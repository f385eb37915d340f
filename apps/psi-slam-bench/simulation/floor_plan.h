// SPDX-License-Identifier: BSD-3-Clause
// A made-up floor of a building, drawn at random: corridors that cross and so form rings, some of them long
// and bare; between them blocks of rooms with doors and furniture, and halls with pillars; some walls of
// glass. Walls are lines in metres; where one can walk is a graph.
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

/// Where a robot can stand.
struct Place {
  enum class Kind { kCrossing, kCorridor, kRoom };
  mrpt::math::TPoint2D at;
  Kind kind = Kind::kCrossing;
};

/// A straight way between two places that nothing stands in, to be gone either way.
struct Passage {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// From one end of the building to the other.
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

  double corridors_m() const;  ///< the length of all corridors
  std::size_t rooms() const;   ///< halls included
};

struct FloorPlanOptions {
  std::uint64_t seed = 1;
  double corridors_m = 150;  ///< the least length of all corridors; never less than once round one block
  double glass_share = 0.1;  ///< of the rooms' fronts and of the outer wall that is glass, in [0, 1]
  double bare_share = 0.25;  ///< of the corridors' stretches that have neither doors nor anything else
  double hall_share = 0.15;  ///< of the blocks that are one hall
};

/// Draws the plan; the same options give the same plan. Passages keep `kPlanClearance_m` from all segments.
FloorPlan draw_floor_plan(const FloorPlanOptions& options);

inline constexpr double kPlanClearance_m = 0.45;

}  // namespace psi_slam
