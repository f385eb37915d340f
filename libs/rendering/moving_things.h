// SPDX-License-Identifier: BSD-3-Clause
// Finds the obstacles of a map that were not there at other times: people, carts and doors that moved.
//
// The scans are divided into intervals of a second. In each interval, an occupied cell of the map is seen
// occupied if any beam ended within 0.15 m of it. Otherwise it is seen free if any beam crossed it and ended
// at least 0.3 m beyond. The tolerances absorb errors of poses and ranges, and beams that graze a wall. Each
// visit counts for at most five intervals of either kind, so a person who stands for ten minutes weighs no
// more than one who stands for five seconds.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/grid_map.h"
#include "rendering/grid_layout.h"
#include "rendering/scan_rays.h"

namespace psi_slam {

struct MovingThingsOptions {
  double interval_s = 1;
  double near_m = 0.15;
  double beyond_m = 0.3;
  double max_range_m = 10;
  int most_of_run = 5;
  std::size_t gap = 10;
  int patch = 2;
  double share = 0.3;
  double least = 2;
};

class MovingThings {
 public:
  /// `grid` is the map of all scans.
  MovingThings(const mrpt::maps::COccupancyGridMap2D& grid, const GridLayout& layout,
               const GridMapOptions& options, const MovingThingsOptions& moving = {});

  /// Adds what a frame saw. Call with the frames in the order of time.
  void add(const Frame& frame, const mrpt::math::TPose2D& map_T_robot);

  /// Makes the cells of moving things free in the map.
  void remove_from(mrpt::maps::COccupancyGridMap2D& grid);

  /// What the intervals say about an occupied cell of the map.
  struct Sightings {
    std::int64_t index = 0;       ///< of the cell in the map
    std::uint32_t hit_in = 0;     ///< last interval with a beam that ended close by
    std::uint32_t passed_in = 0;  ///< last interval with a beam that crossed the cell
    std::uint32_t seen_in = 0;    ///< last interval that counted
    std::uint16_t occupied = 0;   ///< number of intervals, with a limit for each visit
    std::uint16_t free = 0;       ///< number of intervals, with a limit for each visit
    std::int16_t run = 0;         ///< counted intervals of this visit: positive if occupied, negative if free
  };

 private:
  void end_interval();
  void see(Sightings& cell, bool is_free);
  void mark_hit(const mrpt::math::TPoint2D& end);
  bool is_moving(const Sightings& cell) const;

  GridLayout layout_;
  MovingThingsOptions options_;
  RayMaker maker_;
  std::int64_t reach_ = 0;           ///< near_m in cells
  std::vector<Sightings> cells_;     ///< of the occupied cells of the map
  std::vector<std::int32_t> find_;   ///< index in cells_, or minus the distance to an occupied cell, in cells
  std::vector<std::uint32_t> seen_;  ///< cells hit or passed in this interval
  std::uint32_t interval_ = 1;
  TimeUs interval_start_us_ = 0;
  bool any_ = false;
};

}  // namespace psi_slam
