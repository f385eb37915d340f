// SPDX-License-Identifier: BSD-3-Clause
// Writes the files of a map: for people, robots, MRPT's programs, CAD programs and geographic information
// systems. All files are written atomically. Each function or task throws SystemFailure if a file cannot be
// written.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>

#include <filesystem>
#include <string>

#include "base/worker_pool.h"
#include "map/rendering/map_drawing.h"
#include "map/rendering/map_edits.h"
#include "map/trajectory/trajectory_file.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Pose of the map's frame in a projected coordinate system.
struct GeoReference {
  int epsg = 0;  ///< EPSG number of the coordinate system; 0 for a local system in metres
  double easting_m = 0;
  double northing_m = 0;
  double heading_rad = 0;  ///< heading of the map's x axis, counter-clockwise from east
};

/// Selects the files to write, and sets their scale, lines and place on the earth.
struct MapFileOptions {
  bool png = true;           ///< map.png
  bool ros = true;           ///< map.yaml and map.pgm, for map_server
  bool mrpt = true;          ///< map.gridmap.gz, and map.simplemap.gz with the scans of the nodes
  bool svg = true;           ///< map.svg: walls and path as lines
  bool dxf = true;           ///< map.dxf: walls and path as lines, for CAD programs
  bool geotiff = false;      ///< map.tif
  bool gpkg = false;         ///< map.gpkg: walls, path and zones for geographic information systems
  double print_scale = 100;  ///< scale of map.svg; 100 means 1:100
  MapDrawingOptions lines;   ///< lines of map.svg, map.dxf and map.gpkg
  GeoReference earth;        ///< place of map.tif and map.gpkg on the earth
};

/// Returns tasks that write the selected files, except for map.simplemap.gz. `grid` is the grid map of
/// `result` by draw_grid_map(). `edits` are those of the grid, with their points in its frame; map.gpkg shows
/// the zones among them. All arguments but the folder must outlive the tasks.
Tasks map_file_tasks(const std::filesystem::path& folder, const MappingResult& result,
                     const mrpt::maps::COccupancyGridMap2D& grid, const std::vector<MapEdit>& edits,
                     const MapFileOptions& options);

/// Returns MRPT's simple map: the nodes of the graph with their scans, without superseded ones. Each pose has
/// the covariance (1 mm)^2, (1 mrad)^2 as a placeholder that MRPT can invert, because the marginals of the
/// graph are not computed.
mrpt::maps::CSimpleMap simple_map(const MappingResult& result);

/// Writes a simple map or a grid map, serialised and gzipped, as MRPT's programs and
/// CSimpleMap::loadFromFile read it. Equal maps give equal bytes.
void write_mrpt_map(const std::filesystem::path& path, const mrpt::serialization::CSerializable& map);

/// Returns the drawing as DXF release 12, which every CAD program reads, in metres in the map's frame. Layer
/// WALLS has closed polylines, layer TRAJECTORY open polylines. Outlines of two points become lines. The
/// header states the unit ($INSUNITS), which later releases define and programs for release 12 skip.
std::string map_dxf(const MapDrawing& drawing);

/// Returns the drawing as SVG that prints at 1:`scale`, with scale bar and axes below the map. Width and
/// height are millimetres of paper, all coordinates metres. The groups "walls" and "trajectory" use map
/// coordinates.
std::string map_svg(const MapDrawing& drawing, double scale);

/// Throws UserError unless `epsg` is 0 or the number of a projected coordinate system in metres.
void check_epsg(int epsg);

/// Writes a GeoTIFF file with one band of bytes: the probability of occupied space in percent, 255 in unknown
/// cells. Throws UserError like check_epsg().
void write_geo_tiff(const std::filesystem::path& path, const mrpt::maps::COccupancyGridMap2D& grid,
                    const GeoReference& reference = {});

/// Writes a GeoPackage, a database that geographic information systems read, with four layers:
///
///     walls     the outlines as lines, closed unless they have two points
///     path      a line for each run of at least two poses: `run`, counted from 1; `start` and `end`, UTC. M
///               of its points is the time in seconds, as in the log.
///     keep_out  polygons: `zone`, its number as in zones.txt
///     slow      polygons: `zone`; `percent` of the largest speed or `max_speed_mps`, the other is null
///
/// Without EPSG number, the system is the undefined Cartesian one (srs_id -1). The file states the time of
/// the last pose as its date, so that equal maps give equal bytes. Throws UserError like check_epsg().
void write_geo_package(const std::filesystem::path& path, const std::vector<MapLine>& walls,
                       const std::vector<Trajectory>& runs, const std::vector<MapEdit>& edits,
                       const GeoReference& reference = {});

}  // namespace psi_slam
