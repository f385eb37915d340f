// SPDX-License-Identifier: BSD-3-Clause
// The map as lines for drawings: outlines of walls, and the robot's path.
//
// An outline passes through the centres of the outermost cells of a wall: returns lie anywhere in their cell,
// so its centre is the surface to within half a cell. The outline of a wall one cell thick runs there and
// back on the same line. A thick wall seen from both sides has an outline for each surface.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "rendering/map_image.h"

namespace psi_slam {

struct MapDrawingOptions {
  double tolerance_m = 0.05;  ///< largest deviation of a simplified line
  double min_wall_m = 0.1;    ///< walls smaller than this in both directions are left out
};

/// Points in the map's frame.
using MapLine = std::vector<mrpt::math::TPoint2D>;

/// Returns the rectangle of the cells seen.
MapRectangle seen_extent(const mrpt::maps::COccupancyGridMap2D& grid, const SeenCells& seen);

struct MapDrawing {
  std::vector<MapLine> walls;         ///< closed; a line of two points runs there and back
  std::vector<MapLine> trajectories;  ///< open, one for each run
  MapRectangle extent;                ///< of all lines and of everything seen
  double cell_m = 0;                  ///< thickness of an outline
};

/// Traces the walls of the grid and the paths (robot poses in the map, one path for each run). Equal input
/// gives equal lines in the same order.
MapDrawing draw_map_lines(const mrpt::maps::COccupancyGridMap2D& grid,
                          const std::vector<std::vector<mrpt::math::TPose2D>>& paths,
                          const MapDrawingOptions& options = {});

}  // namespace psi_slam
