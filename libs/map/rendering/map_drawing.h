// SPDX-License-Identifier: BSD-3-Clause
// The map as lines for drawings: outlines of walls, and the paths of the robot.
//
// An outline passes through the centres of the outermost cells of a wall. Returns lie anywhere in their cell,
// so the surface is within half a cell of the centre. The outline of a wall one cell thick runs along the
// wall and back on the same line. A thick wall seen from both sides has an outline for each surface.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "map/rendering/map_image.h"

namespace psi_slam {

struct MapDrawingOptions {
  double tolerance_m = 0.05;  ///< largest deviation of a simplified line from the original one
  double min_wall_m = 0.1;    ///< walls that are smaller than this along x and along y are left out
};

/// A line through points in the map's frame, in metres.
using MapLine = std::vector<mrpt::math::TPoint2D>;

/// Returns the rectangle of the observed cells in the map's frame, in metres.
MapRectangle seen_extent(const mrpt::maps::COccupancyGridMap2D& grid, const SeenCells& seen);

struct MapDrawing {
  std::vector<MapLine> walls;         ///< closed outlines; a line of two points runs there and back
  std::vector<MapLine> trajectories;  ///< open lines, one for each run
  MapRectangle extent;                ///< rectangle around all lines and all observed cells
  double cell_m = 0;                  ///< side length of a cell, which is the thickness of an outline
};

/// Traces the walls of the grid and simplifies the paths. `paths` holds the robot's poses in the map, one
/// path for each run. Equal input gives equal lines in the same order.
MapDrawing draw_map_lines(const mrpt::maps::COccupancyGridMap2D& grid,
                          const std::vector<std::vector<mrpt::math::TPose2D>>& paths,
                          const MapDrawingOptions& options = {});

}  // namespace psi_slam
