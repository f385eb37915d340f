// SPDX-License-Identifier: BSD-3-Clause
// The global grid map: all scans of a log drawn at their mapped poses into MRPT's COccupancyGridMap2D.
//
// Each beam is cast along its own bearing. (MRPT's insertObservation spreads n beams over the aperture in n
// steps instead of n - 1, so its last beam is off by a whole step: one degree for the usual 180 beams.) Each
// scan counts once per cell: as a hit if one of its beams ends in the cell, else as a pass if one crosses it.
// A hit weighs three times a pass, so a cell is a wall if more than a quarter of the scans that saw it hit
// it. The map depends neither on the order of the scans nor on their number of beams.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

struct GridMapOptions {
  double resolution_m = 0.05;  ///< side of a cell
  double max_range_m = 30;     ///< a longer beam is drawn up to this range, as free space only
  double margin_m = 0.5;       ///< of unknown space around everything seen
  /// Limit of the map's size, so that a log mapped wrongly does not exhaust the memory (four bytes per cell
  /// while drawing, one after). The cell size is doubled until the map has at most this many cells;
  /// coarser_cells_text() reports it.
  std::size_t max_cells = 100'000'000;
};

/// Draws every scan of `log` at the robot pose of the same index. Cells are 0 (occupied) to 1 (free), 0.5
/// where nothing was seen. The corners of the map lie on multiples of the cell size and enclose everything
/// seen plus the margin. Beams without return are ignored. Throws std::invalid_argument if the counts differ,
/// an option is out of range, or a pose is not finite.
mrpt::maps::COccupancyGridMap2D::Ptr draw_grid_map(const std::vector<Frame>& log,
                                                   const std::vector<mrpt::math::TPose2D>& map_T_robot,
                                                   const GridMapOptions& options = {});

}  // namespace psi_slam
