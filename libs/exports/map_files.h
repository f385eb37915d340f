// SPDX-License-Identifier: BSD-3-Clause
// Which files a map is written to: for people, robots, MRPT's programs, CAD and geographic information
// systems.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>

#include "psi_slam/mapping_result.h"
#include "exports/geo_tiff.h"
#include "rendering/map_drawing.h"

namespace psi_slam {

struct MapFileOptions {
  bool png = true;           ///< map.png
  bool ros = true;           ///< map.yaml and map.pgm, for map_server
  bool mrpt = true;          ///< map.gridmap.gz, and map.simplemap.gz with the nodes' scans
  bool svg = true;           ///< map.svg: walls and path as lines
  bool dxf = true;           ///< map.dxf: the same for CAD
  bool print = false;        ///< map_print.png, true to scale
  bool geotiff = false;      ///< map.tif
  double print_scale = 100;  ///< of map_print.png and map.svg: 1:100
  int print_dpi = 300;
  MapDrawingOptions lines;  ///< of map.svg and map.dxf
  GeoReference earth;       ///< of map.tif, and north on map_print.png
};

/// Writes those files, each whole or not at all, and removes the others if they are there: a map without them
/// would stand beside those of another. `grid` is the map of `result` as draw_grid_map makes it. Throws
/// SystemFailure when the disk does not take one.
void write_map_files(const std::filesystem::path& folder, const MappingResult& result,
                     const mrpt::maps::COccupancyGridMap2D& grid, const MapFileOptions& options = {});

}  // namespace psi_slam
