// SPDX-License-Identifier: BSD-3-Clause
// Extent of a grid map, and what a cell shows.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TBoundingBox.h>

#include <cstdint>

#include "psi_slam/grid_map.h"

namespace psi_slam {

/// Extent of the grid. (x_min, y_min) is the offset of its lower left corner from the map's origin; all but
/// the resolution are in cells.
struct GridLayout {
  double resolution_m = 0;
  std::int64_t x_min = 0;
  std::int64_t y_min = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;

  bool operator==(const GridLayout& other) const {
    return resolution_m == other.resolution_m && x_min == other.x_min && y_min == other.y_min &&
           width == other.width && height == other.height;
  }
};

/// Returns the extent of a map of everything within `bounds`, in metres, with its margin. Doubles the
/// resolution until the map has at most options.max_cells cells.
GridLayout layout_for(const mrpt::math::TBoundingBox& bounds, const GridMapOptions& options);

/// Returns a grid of unknown cells.
mrpt::maps::COccupancyGridMap2D::Ptr unknown_grid(const GridLayout& layout);

/// Evidence of one frame about a cell: a hit adds, a pass subtracts.
inline constexpr int kHitEvidence = 3;
inline constexpr int kPassEvidence = -1;

/// Returns the value of a cell, MRPT's log-odds that it is free, for the sum of its evidence.
mrpt::maps::COccupancyGridMap2D::cellType cell_value(std::int64_t evidence);

/// Throws std::invalid_argument if an option is out of range.
void check_drawable(const GridMapOptions& options);

}  // namespace psi_slam
