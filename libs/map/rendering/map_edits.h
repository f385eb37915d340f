// SPDX-License-Identifier: BSD-3-Clause
// Edits of a drawn grid map, and zones that restrict robots.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace psi_slam {

struct MapEdit {
  enum class Kind {
    kErase,    ///< the polygon becomes free
    kUnknown,  ///< the polygon becomes unknown
    kWall,     ///< the line becomes a wall
    kCrop,     ///< only the polygon is kept; the map shrinks to it
    kKeepOut,  ///< zone that robots must not enter; the map stays as it is
    kSlow,     ///< zone in which robots must be slow; the map stays as it is
  };

  Kind kind = Kind::kErase;
  std::vector<mrpt::math::TPoint2D> points;  ///< corners of the polygon, or points of the line, in metres
  double width_m = 0;                        ///< of a wall; all cells that its line crosses are drawn
  double percent = 0;                        ///< of a slow zone: share of the largest speed; 0: none given
  double max_speed_mps = 0;                  ///< of a slow zone: largest speed; 0: none given
  /// Pose of the robot at `scan` in the frame of `points`, which ties the edit to the place where the robot
  /// was. Empty: the frame of `points` is that of the exported map.
  std::optional<mrpt::math::TPose2D> frame_T_robot{};
  std::size_t scan = 0;  ///< number of the scan, in the order of the log

  bool is_zone() const { return kind == Kind::kKeepOut || kind == Kind::kSlow; }
};

/// Number of points that an edit needs at least.
inline std::size_t least_points(MapEdit::Kind kind) {
  return kind == MapEdit::Kind::kWall ? 2 : 3;
}

/// Words for people, such as "erase polygon" and "add slow zone of 40 %".
std::string text_of(const MapEdit& edit);

/// Calls `visit(x, y)` for each cell of the grid that the edit covers: cells with their centre in the
/// polygon, or within half the width of the line, at least half the diagonal of a cell. Returns the number of
/// these cells. The points must be in the frame of the grid.
std::size_t for_each_cell_of(const MapEdit& edit, const mrpt::maps::COccupancyGridMap2D& grid,
                             const std::function<void(int x, int y)>& visit);

/// Applies the edits in their order, with points in the frame of the grid. Zones change nothing. Returns one
/// sentence, without full stop, for each edit that covers no cell of the map, and for each zone that covers
/// none after all edits.
std::vector<std::string> apply_map_edits(const std::vector<MapEdit>& edits,
                                         mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace psi_slam
