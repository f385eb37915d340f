// SPDX-License-Identifier: BSD-3-Clause
// The map as lines, for drawings: outlines of what is occupied, and the robot's path.
//
// An outline runs through the centres of the outermost cells of a wall: a laser's returns lie anywhere in
// their cell, so its centre is where the surface is, give or take half a cell. A wall one cell thin is there
// and back on one line; a wall that was seen from both sides only on its surfaces has an outline for each.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

namespace psi_slam {

struct MapDrawingOptions {
  double tolerance_m = 0.05;  ///< what a line may deviate from what it is simplified from
  double min_wall_m = 0.1;    ///< occupied spots that are smaller both ways are left out
};

/// In the map's frame.
using MapLine = std::vector<mrpt::math::TPoint2D>;

/// A rectangle in the map's frame.
struct DrawingExtent {
  double x_min_m = 0;
  double x_max_m = 0;
  double y_min_m = 0;
  double y_max_m = 0;

  double width_m() const { return x_max_m - x_min_m; }
  double height_m() const { return y_max_m - y_min_m; }
};

struct MapDrawing {
  std::vector<MapLine> walls;  ///< closed; those of two points are there and back
  std::vector<MapLine> trajectories;  ///< open; one a drive
  DrawingExtent extent;        ///< of all lines and of all that was seen
  double cell_m = 0;           ///< how thick an outline is
};

/// The same grid and paths, one of each drive, give the same lines, in the same order.
MapDrawing draw_map_lines(const mrpt::maps::COccupancyGridMap2D& grid,
                          const std::vector<std::vector<mrpt::math::TPose2D>>& paths,
                          const MapDrawingOptions& options = {});

}  // namespace psi_slam
