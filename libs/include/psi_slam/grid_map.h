// SPDX-License-Identifier: BSD-3-Clause
// The global occupancy grid: every scan of the log drawn at its mapped pose into MRPT's COccupancyGridMap2D.
//
// Beams are cast along their own bearings. (MRPT's insertObservation spreads n beams over the aperture in n
// steps where a scan has n - 1: its last beam is a whole step off, a degree on the usual 180.) In a scan a
// cell counts once: as hit if any of its beams ended there, else as passed if any went through. Over all
// scans a hit weighs three times a pass, and nothing saturates on the way: a cell is a wall when more than a
// quarter of the scans that saw it hit it. Neither does the order of the scans matter, nor the number of
// beams.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

struct GridMapOptions {
  double resolution_m = 0.05;
  double max_range_m = 30;  ///< longer beams are drawn up to here, as free space only
  double margin_m = 0.5;    ///< of unknown space around all that was seen
  /// The resolution is doubled until the map has no more cells than this (four bytes each while drawing, one
  /// after): a map that fell apart shall not exhaust the memory. coarser_cells_text() tells it.
  std::size_t max_cells = 100'000'000;
};

/// The map of all scans of `log`, each at the robot's pose of the same index. Cells are 0 occupied, 0.5 never
/// seen, 1 free. Its corners lie on multiples of the resolution, and hold what was seen with the margin.
/// Beams without return draw nothing. Throws std::invalid_argument when the counts differ, or when an option
/// or a pose is no sensible number.
mrpt::maps::COccupancyGridMap2D::Ptr draw_grid_map(const std::vector<Frame>& log,
                                                   const std::vector<mrpt::math::TPose2D>& map_T_robot,
                                                   const GridMapOptions& options = {});

}  // namespace psi_slam
