// SPDX-License-Identifier: BSD-3-Clause
// All files of a map: for people, robots, MRPT's programs, CAD programs and geographic information systems.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>

#include "exports/geo_tiff.h"
#include "psi_slam/mapping_result.h"
#include "rendering/map_drawing.h"

namespace psi_slam {

/// Which files to write, and how.
struct MapFileOptions {
  bool png = true;           ///< map.png
  bool ros = true;           ///< map.yaml and map.pgm, for map_server
  bool mrpt = true;          ///< map.gridmap.gz, and map.simplemap.gz with the scans of the nodes
  bool svg = true;           ///< map.svg: walls and path as lines
  bool dxf = true;           ///< map.dxf: walls and path as lines, for CAD programs
  bool print = false;        ///< map_print.png, true to scale
  bool geotiff = false;      ///< map.tif
  double print_scale = 100;  ///< of map_print.png and map.svg: 1:100
  int print_dpi = 300;       ///< of map_print.png
  MapDrawingOptions lines;   ///< of map.svg and map.dxf
  GeoReference earth;        ///< of map.tif, and of north in map_print.png
};

/// Writes the files asked for, each atomically, and deletes the others, which would show an older map. `grid`
/// is the map of `result` by draw_grid_map. Throws SystemFailure if a file cannot be written.
void write_map_files(const std::filesystem::path& folder, const MappingResult& result,
                     const mrpt::maps::COccupancyGridMap2D& grid, const MapFileOptions& options = {});

}  // namespace psi_slam
