// SPDX-License-Identifier: BSD-3-Clause
// Finds the obstacles of a map that were not there at other times: people, carts and doors that moved.
//
// The scans are divided into intervals of a second. In each interval, an occupied cell of the map is seen
// occupied if any beam ended within 0.15 m of it. Otherwise it is seen free if a beam crossed it and ended at
// least 0.3 m beyond. The tolerances absorb errors of poses and ranges. Where the obstacle is straight, only
// beams that cross it at 30 degrees or more count, because the others may graze a wall. Each visit counts for
// at most five intervals of either kind, so a person who stands for ten minutes weighs no more than one who
// stands for five seconds. A moving thing was seen free in at least a quarter of the counted intervals.
//
// Obstacles longer than two metres stay if the beams hit them as one surface: a wall in two places after an
// error of the poses, or a barrier that beams hit only from some directions.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/grid_map.h"
#include "rendering/digital_line.h"
#include "rendering/grid_layout.h"
#include "rendering/scan_rays.h"

namespace psi_slam {

class MovingThings {
 public:
  /// `grid` is the map of all scans, with this layout.
  MovingThings(const mrpt::maps::COccupancyGridMap2D& grid, const GridLayout& layout,
               const GridMapOptions& options);

  /// Adds what a frame saw. Call with the drawn frames in their order. Throws as RayMaker::fans() does.
  void add(const Frame& frame, const mrpt::math::TPose2D& map_T_robot);

  /// Makes the cells of moving things free in the map. Call once, after all frames.
  void remove_from(mrpt::maps::COccupancyGridMap2D& grid);

 private:
  /// Number of intervals that saw a place occupied or free, with a limit for each visit.
  struct Tally {
    std::uint16_t occupied = 0;
    std::uint16_t free = 0;
    std::int16_t run = 0;  ///< counted intervals of this visit: positive if occupied, negative if free

    /// Counts an interval. `is_new_visit` is false if the last interval that saw the place was close in time.
    void count(bool is_free, bool is_new_visit);
  };

  /// What the intervals say about an occupied cell of the map.
  struct Sightings {
    std::int32_t x = 0;  ///< column and row of the cell in the map
    std::int32_t y = 0;
    float normal_x = 0;  ///< unit vector across a straight obstacle; 0 if the obstacle is not straight
    float normal_y = 0;
    std::uint32_t hit_in = 0;      ///< last interval with a beam that ended within near_ cells
    std::uint32_t touched_in = 0;  ///< last interval with a beam that ended in the cell or beside it
    std::uint32_t surface_in = 0;  ///< last interval in which that beam was one of a large surface
    std::uint32_t passed_in = 0;   ///< last interval with a beam that crossed the cell
    std::uint32_t seen_in = 0;     ///< last interval that saw the cell
    std::uint16_t hits = 0;        ///< number of intervals with a beam that ended within near_ cells
    std::uint16_t surface = 0;     ///< number of these in which a large surface was hit
    Tally near;                    ///< occupied if a beam ended within near_ cells
    Tally close;                   ///< occupied if a beam ended in the cell or beside it
  };

  void find_obstacles(const mrpt::maps::COccupancyGridMap2D& grid);
  void find_normal(Sightings& cell) const;
  void mark_hits(const Fan& fan, const CellBox& map);
  void mark_hit(const mrpt::math::TPoint2D& end, bool of_surface);
  void mark_passes(const Fan& fan, const CellBox& map);
  void mark_seen(std::int32_t found);
  void end_interval();
  void see(Sightings& cell);
  bool is_moving(const Sightings& cell) const;
  void spread(std::vector<bool>& is_moving) const;
  void keep_large_surfaces(std::vector<bool>& is_moving) const;

  /// Calls `visit` with the index in cells_ of each obstacle at most `reach` columns and rows from (x, y).
  template <class Visit>
  void for_each_around(std::int64_t x, std::int64_t y, std::int64_t reach, const Visit& visit) const;

  GridLayout layout_;
  RayMaker maker_;
  std::int64_t near_ = 0;            ///< reach of a hit, in cells
  std::vector<Sightings> cells_;     ///< of the occupied cells of the map
  std::vector<std::int32_t> find_;   ///< index in cells_, or minus the distance to an occupied cell, in cells
  std::vector<std::uint32_t> seen_;  ///< indices of the cells that this interval saw
  std::uint32_t interval_ = 0;       ///< number of this interval; 0 before the first frame
  TimeUs interval_start_us_ = 0;
};

}  // namespace psi_slam
