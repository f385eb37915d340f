// SPDX-License-Identifier: BSD-3-Clause
// Finds the newest confirmed state of each place of a map. Removes dynamic objects (people, carts and doors
// that moved), and keeps objects that came and stayed.
//
// Observations. The scans are divided into intervals; a new interval begins when the robot has moved 0.08 m
// or a second has passed. An interval sees an occupied cell of the map as occupied if a beam ended within
// 0.12 m or 1.5 cells of it. Otherwise it sees the cell as free if beams crossed the cell and ended beyond
// it. All beams within 0.12 m of these beams, and at least one on either side, must also end beyond the cell,
// because a beam that grazes a surface does not show free space. The tolerances allow for errors of poses and
// ranges.
//
// Weights. Three beams within 5 m have the weight 1 in cells of 0.05 m; fewer or longer beams have less. A
// beam counts once for each obstacle within the tolerance that it crosses, so a person gets more weight than
// a post. The weight of one visit of the robot is at most 12, because the poses of a visit share their
// errors.
//
// Removal. A cell is refuted if its free weight is at least 1, plus 0.7 for each further visit that saw the
// cell occupied, plus 1 for each time that it was seen occupied again after it was seen free. The threshold
// is up to four times as high if beams hit the cell as part of a large surface. A free weight below 0.9
// between two sightings of the obstacle does not count, because beams miss thin objects. So a table leg that
// many beams miss stays, and the time for which a person stands does not matter. Cells within 0.25 m that
// were seen occupied throughout the same time are judged together.
//
// Neighbours. A cell within 0.15 m of a refuted cell vanishes, too, if it was occupied only during the same
// time and one of two conditions holds. Either its free weight reaches 0.3 of the threshold. Or the beams
// that crossed it before the first and after the last beam that ended in it have a total weight of 1. So the
// ends of a door beside its frame vanish. A cell in which beams ended also vanishes if at least 35 % of all
// obstacles within 0.25 m vanish and were hit for as long.
//
// Newest state. A refuted cell is gone in two cases. Either the observations after its last hit refute it. Or
// two passes at correct poses saw it free since then, and these are more free passes than in any earlier
// period after which it was seen occupied again. Otherwise the cell was free only before its last hit. Then
// it stays if two passes saw enough of the obstacles around it: the robot travelled 8 m or more, and half a
// minute later saw them again from the same place. Else the cell is doubtful and becomes unknown. A cell that
// only the newest scans show as occupied becomes unknown, too, unless two passes saw it.
//
// Large surfaces. Obstacles longer than 1.5 m stay if beams hit them as one surface. Examples are a wall that
// wrong poses draw at two places, or a barrier that beams hit only from some directions. They are gone if two
// passes at correct poses saw most of them free. The poses of a pass are correct if its beams hit more of the
// obstacles known before than they crossed, in each direction that the obstacles face.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "map/rendering/cell_box.h"
#include "map/rendering/grid_layout.h"
#include "map/rendering/obstacle_field.h"
#include "map/rendering/scan_rays.h"
#include "psi_slam/frame.h"
#include "psi_slam/grid_map.h"

namespace psi_slam {

/// A cell of the map that all scans together do not show as occupied, though the newest scans do.
struct NewObstacle {
  std::int32_t x = 0;  ///< column and row in the map
  std::int32_t y = 0;
  mrpt::maps::COccupancyGridMap2D::cellType of_all_scans = 0;  ///< value by all scans
};

class MovingThings {
 public:
  /// `grid` is the map of all scans, with this layout. Shows those new obstacles in it that are not the rim
  /// of a wall, until update().
  MovingThings(mrpt::maps::COccupancyGridMap2D& grid, const std::vector<NewObstacle>& new_obstacles,
               const GridLayout& layout, const GridMapOptions& options);

  /// Adds what a frame saw. Call with the drawn frames in their order. Throws as RayMaker::fans() does.
  void add(const Frame& frame, const mrpt::math::TPose2D& map_T_robot);

  /// Shows the newest confirmed state of each cell in the map. Call once, after all frames.
  void update(mrpt::maps::COccupancyGridMap2D& grid);

 private:
  /// A place on the path of the robot.
  struct PathMark {
    TimeUs time_us = 0;
    double path_m = 0;           ///< length of the path up to here
    mrpt::math::TPoint2D robot;  ///< position of the robot
  };

  /// What the intervals say about an occupied cell of the map.
  struct Sightings {
    std::int32_t x = 0;  ///< column and row of the cell in the map
    std::int32_t y = 0;
    float normal_x = 0;  ///< unit vector across a straight obstacle; 0 if the obstacle is not straight
    float normal_y = 0;
    std::uint32_t hit_in = 0;      ///< last interval with a beam that ended in the cell
    std::uint32_t surface_in = 0;  ///< last interval in which that beam was one of a large surface
    std::uint32_t passed_in = 0;   ///< last interval with a beam that crossed the cell
    float beams = 0;               ///< weight of the beams that crossed the cell in that interval
    std::uint32_t seen_in = 0;     ///< last interval that saw the cell
    std::uint32_t first_hit = 0;   ///< first interval that saw the cell occupied; 0 if none did
    std::uint32_t last_hit = 0;    ///< last interval that saw the cell occupied
    std::uint32_t first_end = 0;   ///< first interval with a beam that ended in the cell itself; 0 if none
    std::uint32_t last_end = 0;    ///< last such interval
    std::uint16_t hits = 0;        ///< number of intervals that saw the cell occupied
    std::uint16_t surface = 0;     ///< number of these in which a large surface was hit
    std::uint16_t visits = 0;      ///< number of visits that saw the cell occupied
    std::uint16_t returns = 0;     ///< number of times that it was seen occupied again after free
    float free = 0;                ///< weight of the intervals that saw the cell free, without short gaps
    float free_of_visit = 0;       ///< part of it since the start of the visit or the last hit
    float free_since_hit = 0;      ///< part of it since the last hit
    float crossed_before = 0;      ///< weight of the intervals that crossed the cell before first_end
    float crossed_after = 0;       ///< and after last_end
    /// Weight since free_since of the intervals that saw it free at poses that agree with obstacles around.
    float free_of_pass = 0;
    PathMark occupied_since;           ///< first sighting of the state in which it was last seen occupied
    double hit_m = 0;                  ///< path of the robot up to the last sighting
    PathMark free_since;               ///< start of the last pass that saw it free, in such intervals
    std::uint16_t free_passes = 0;     ///< passes since the last hit whose free_of_pass reached 1
    std::uint16_t returned_after = 0;  ///< largest such number before a hit
    bool stays = false;                ///< whether two passes saw it occupied since occupied_since
    bool is_new = false;               ///< whether all scans together do not show it occupied
    mrpt::maps::COccupancyGridMap2D::cellType of_all_scans = 0;  ///< their value, if is_new
  };

  /// A beam that ended on a straight obstacle or crossed it.
  struct Evidence {
    double since_m = 0;  ///< path of the robot up to the first sighting of the obstacle
    /// Upper triangle of n nᵀ of the obstacle's normal n, negative for a beam that crossed it. In the end,
    /// the sum over all evidence up to this.
    double xx = 0;
    double xy = 0;
    double yy = 0;
  };

  /// What becomes of an obstacle of the map.
  enum class Fate : std::uint8_t {
    kStays,
    kConfirmed,  ///< seen free before, and occupied afterwards by two passes
    kGone,       ///< seen free afterwards
    kDoubtful,   ///< seen free before, and occupied afterwards by one pass only
  };

  static constexpr double kLargeSurface_m = 1.5;  ///< length of a surface that may be a wall

  /// Returns the number of cells that reach as far as a length.
  std::int64_t cells_in(double length_m) const {
    return static_cast<std::int64_t>(std::ceil(length_m / layout_.resolution_m - 1e-9));
  }

  void list_obstacles(const mrpt::maps::COccupancyGridMap2D& grid);
  void find_normal(Sightings& cell) const;
  void follow_path(const mrpt::math::TPoint2D& robot);
  bool is_second_pass(const PathMark& since) const;
  void add_evidence(const Sightings* obstacle, double sign);
  void sum_evidence();
  void mark_hits(const Fan& fan, const CellBox& map);
  void mark_hit(const mrpt::math::TPoint2D& end, bool of_surface);
  void mark_passes(const Fan& fan, const CellBox& map);
  void mark_pass(std::int32_t found, float weight);
  void mark_seen(std::int32_t found);
  void end_interval();
  bool is_hit_near(const Sightings& cell) const;
  void see_occupied(Sightings& cell, bool is_new_visit);
  void see_free(Sightings& cell);
  void see_crossed(Sightings& cell) const;
  bool agrees_with_obstacles_before(double path_m) const;
  static double refuted(const Sightings& cell, float free);
  static double gone(const Sightings& cell);
  template <class Refuted>
  bool is_refuted(const Sightings& cell, const Refuted& refuted) const;
  static bool vanishes(Fate fate) { return fate == Fate::kGone || fate == Fate::kDoubtful; }
  std::vector<Fate> fates() const;
  void keep_confirmed(std::vector<Fate>& fates) const;
  bool is_changed_surface(const std::vector<std::size_t>& part) const;
  void keep_large_surfaces(std::vector<Fate>& fates) const;
  void add_rims(std::vector<Fate>& fates) const;

  /// Calls `visit` with the index in cells_ of each obstacle at most `reach` columns and rows from (x, y).
  template <class Visit>
  void for_each_around(std::int64_t x, std::int64_t y, std::int64_t reach, const Visit& visit) const;

  /// Calls `visit` with the index in cells_ of each obstacle within the tolerance of a hit in the cell (x,
  /// y).
  template <class Visit>
  void for_each_near(std::int64_t x, std::int64_t y, const Visit& visit) const;

  GridLayout layout_;
  RayMaker maker_;
  std::int64_t near_ = 0;            ///< reach of a hit, in cells
  float beams_ = 0;                  ///< weight of the beams that count as one free interval
  float share_of_near_ = 1;          ///< share by which the beams through cells near count
  ObstacleField obstacles_;          ///< the occupied cells of the map
  std::vector<Sightings> cells_;     ///< of the occupied cells, by their number
  std::vector<std::uint32_t> seen_;  ///< indices of the cells that this interval saw
  std::uint32_t interval_ = 0;       ///< number of this interval; 0 before the first frame
  TimeUs interval_start_us_ = 0;
  mrpt::math::TPoint2D interval_start_;  ///< position of the robot at the start of the interval
  PathMark here_;                        ///< the robot in this interval
  std::vector<Evidence> evidence_;       ///< about the poses of this interval
};

template <class Visit>
void MovingThings::for_each_around(std::int64_t x, std::int64_t y, std::int64_t reach,
                                   const Visit& visit) const {
  const std::int64_t y_end = std::min(y + reach, layout_.height - 1);
  const std::int64_t x_end = std::min(x + reach, layout_.width - 1);
  for (std::int64_t at_y = std::max<std::int64_t>(y - reach, 0); at_y <= y_end; ++at_y)
    for (std::int64_t at_x = std::max<std::int64_t>(x - reach, 0); at_x <= x_end; ++at_x) {
      const std::int32_t found = obstacles_.find(static_cast<std::size_t>(at_y * layout_.width + at_x));
      if (found >= 0) visit(found);
    }
}

}  // namespace psi_slam
