// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Draws the occupancy grid of all scans, each at its mapped pose, into MRPT's COccupancyGridMap2D.
///
/// Beams follow their own bearings. MRPT's insertObservation() instead divides the aperture of n beams into n
/// steps, although there are only n - 1. Its last beam is therefore one step off: 1 degree for a usual scan
/// of 180 degrees.
///
/// Each scan counts once per cell. It is a hit if any beam ended in the cell, otherwise a pass if any beam
/// crossed the cell. Over all scans, a hit weighs three times a pass and counts do not saturate. A cell is
/// occupied if more than a quarter of the scans that saw it hit it. The map depends neither on the order of
/// the scans nor on the number of beams.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Options of draw_grid_map(): section [map] of settings files.
struct GridMapOptions {
  double resolution_m = 0.05;  ///< side of a cell, metres
  double max_range_m = 200;    ///< longer beams are drawn as free space up to this range
  /// Beams without return make unknown cells free up to this length, but not beyond the sensor's maximum
  /// range. Glass and black surfaces give no return either, so such beams never outvote a hit. 0: beams
  /// without return draw nothing.
  double no_return_clears_m = 5;
  double margin_m = 0.5;  ///< width of the unknown border around all observed cells
  /// The cell size is doubled until the map has at most this many cells. A cell takes four bytes while
  /// drawing and one byte afterwards. The limit keeps a badly distorted map from exhausting the memory.
  std::size_t max_cells = 100'000'000;
};

/// Draws the scans of `log`, each at the robot pose with the same index. Cells are 0 if occupied, 0.5 if
/// never observed and 1 if free. The corners of the map lie on multiples of the resolution and include the
/// margin. Invalid readings draw nothing. Throws std::invalid_argument if the numbers of scans and
/// poses differ, or if an option or a pose is not finite or out of range.
mrpt::maps::COccupancyGridMap2D::Ptr draw_grid_map(const std::vector<Frame>& log,
                                                   const std::vector<mrpt::math::TPose2D>& map_T_robot,
                                                   const GridMapOptions& options = {});

}  // namespace psi_slam
