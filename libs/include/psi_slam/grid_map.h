// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Draws the occupancy grid of all scans, each at its mapped pose, into MRPT's COccupancyGridMap2D.
///
/// Beams follow their own bearings. MRPT's insertObservation() instead divides the aperture of n beams into n
/// steps, although there are only n - 1. Its last beam is therefore one step off: 1 degree for a usual scan
/// of 180 degrees.
///
/// Each frame counts once per cell, with the scans of all its lasers: as a hit if any beam ended in the cell,
/// otherwise as a pass if any beam crossed it. A hit weighs three times a pass. The counts of a cell saturate
/// only after thousands of frames. A cell is occupied if more than a quarter of its counts are hits. The map
/// does not depend on the number of beams. A standstill of 10 s or more counts as at most 64 frames.
///
/// If GridMapOptions::keep_moving is false, each place shows its newest confirmed state: obstacles that later
/// frames saw through are free, and doubtful ones are unknown. What fewer beams than
/// GridMapOptions::min_beams saw is unknown.
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
  double max_range_m = 200;    ///< ends of longer beams are not drawn, only free space up to this range
  /// Beams without return make unknown cells free up to this length, but not beyond the sensor's maximum
  /// range. They never clear occupied cells, because glass and black surfaces give no return either. 0:
  /// beams without return draw nothing.
  double no_return_clears_m = 5;
  double margin_m = 0.5;  ///< width of the unknown border around all observed cells, at least two cells
  /// Maximum number of cells. Larger maps get cells of twice the size, if necessary repeatedly. A cell takes
  /// about six bytes while drawing and one byte afterwards. The limit keeps a badly distorted map from
  /// exhausting the memory.
  std::size_t max_cells = 100'000'000;
  /// Draws people, carts and doors that moved, too. Otherwise, each place shows its newest confirmed state.
  /// Some table legs may vanish, too.
  bool keep_moving = false;
  /// Minimum number of beams that must have seen an obstacle or free space, from 1 to 3. A beam counts as two
  /// where a neighbouring beam of its scan reaches as far. Space that fewer beams saw stays unknown.
  int min_beams = 1;
};

/// Draws the scans of each frame of `log` at the robot pose with the same index, except Frame::is_misplaced. A cell holds the probability
/// that it is free: near 0 if occupied, 0.5 if never observed, near 1 if free. The corners of the map lie on
/// multiples of the resolution and include the margin. Invalid readings draw nothing. Throws
/// std::invalid_argument if the numbers of frames and poses differ, or those of a scan's ranges and bearings.
/// Throws std::invalid_argument also if a pose is not finite or an option is out of range.
mrpt::maps::COccupancyGridMap2D::Ptr draw_grid_map(const std::vector<Frame>& log,
                                                   const std::vector<mrpt::math::TPose2D>& map_T_robot,
                                                   const GridMapOptions& options = {});

}  // namespace psi_slam
