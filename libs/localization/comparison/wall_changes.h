// SPDX-License-Identifier: BSD-3-Clause
// Walls that differ between two aligned maps of a building.
//
// A cell of a wall has changed if the other map shows free space there and on both sides: no wall within the
// tolerance, and at least 90 % free cells within the tolerance (in a square). So these are no changes: space
// that one map does not show, a streak of free cells that a single beam left, and free space in front of a
// wall if the space behind the wall is unknown. Changed cells that touch form one change; short and sparse
// changes are ignored as noise. A changed wall has moved if a parallel wall beside it exists only in the
// other map (moved_walls.h).
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace psi_slam {

struct WallChangeOptions {
  double tolerance_m = 0.15;   ///< walls within this distance of each other are the same wall
  double min_length_m = 0.3;   ///< shorter changes are noise
  double farthest_move_m = 1;  ///< maximum distance between the old and the new place of a moved wall
};

/// A wall, or a part of one, that has changed. Points are in the frame of map A, in metres.
struct WallChange {
  enum class Kind {
    kAppeared,  ///< only map B has the wall
    kVanished,  ///< only map A has the wall
    kMoved,     ///< map B has the wall at another place, beside that in map A
  };

  Kind kind = Kind::kAppeared;
  mrpt::math::TPoint2D from;  ///< ends of the wall along its main direction; in map A if it moved
  mrpt::math::TPoint2D to;
  double length_m = 0;               ///< distance between both ends, with the cells at the ends
  mrpt::math::TPoint2D shift{0, 0};  ///< of a moved wall: from its place in map A to its place in map B

  mrpt::math::TPoint2D middle() const { return (from + to) * 0.5; }
};

/// What a cell shows in both maps.
enum class ComparedCell : std::uint8_t {
  kUnknown,    ///< neither map shows the cell
  kFree,       ///< free in at least one map, and without a wall
  kWall,       ///< wall in both maps, or too little to count as a change
  kWallOfOne,  ///< wall of one map where the other shows too little free space around it
  kAppeared,   ///< part of a wall that appeared, or new place of a wall that moved
  kVanished,   ///< part of a wall that vanished, or old place of a wall that moved
};

/// The comparison as an image in the frame of map A.
struct ComparedCells {
  double x_min_m = 0;  ///< lower left corner of cell (0, 0)
  double y_min_m = 0;
  double cell_m = 0;
  int width = 0;
  int height = 0;
  std::vector<ComparedCell> cells;  ///< row by row from the lower left

  ComparedCell at(int x, int y) const {
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

struct WallChanges {
  std::vector<WallChange> changes;  ///< sorted by kind, then from long to short
  ComparedCells cells;
  double compared_m2 = 0;  ///< area that both maps show
};

/// Compares the walls of two maps; `a_T_b` is the pose of the frame of map B in map A. The result has the
/// cells of map A, or no cells if the maps lie apart. Deterministic.
WallChanges find_wall_changes(const mrpt::maps::COccupancyGridMap2D& a,
                              const mrpt::maps::COccupancyGridMap2D& b, const mrpt::math::TPose2D& a_T_b,
                              const WallChangeOptions& options = {});

}  // namespace psi_slam
