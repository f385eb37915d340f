// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings_parts.h"

namespace psi_slam {

void describe_map(OptionTable& table, GridMapOptions& map) {
  table.section("map", "The map that is written")
      .number("resolution_m", map.resolution_m, between(0.005, 10), "m", "side of a cell")
      .number("max_range_m", map.max_range_m, above(0), "m",
              "longer beams are drawn up to here, as free space only")
      .number("margin_m", map.margin_m, at_least(0).at_most(1000), "m",
              "of unknown space around all that was seen")
      .integer("max_cells", map.max_cells, between(10'000, 1'000'000'000), "cells",
               "a larger map gets coarser cells");
}

void describe_map_files(OptionTable& table, MapFileOptions& files) {
  table.flag("write_png", files.png, "map.png: the map to look at")
      .flag("write_ros", files.ros, "map.yaml and map.pgm: for map_server of ROS 1 and nav2")
      .flag("write_mrpt", files.mrpt, "map.gridmap.gz and map.simplemap.gz: for MRPT's programs")
      .flag("write_svg", files.svg,
            "map.svg: walls and path as lines, in millimetres of paper at print_scale")
      .flag("write_dxf", files.dxf, "map.dxf: walls and path for CAD, in metres")
      .flag("write_print", files.print, "map_print.png: a picture that prints true to scale")
      .flag("write_geotiff", files.geotiff, "map.tif: for geographic information systems")
      .number("print_scale", files.print_scale, above(0).at_most(1e6), "",
              "of map_print.png and map.svg: 100 is 1:100, a centimetre of paper for a metre")
      .integer("print_dpi", files.print_dpi, between(1, 10'000), "dpi",
               "of map_print.png; lowered where the picture had more than 150 million pixels")
      .number("line_tolerance_m", files.lines.tolerance_m, at_least(0).at_most(10), "m",
              "what lines of map.svg and map.dxf may deviate from the cells' outlines")
      .number("min_wall_m", files.lines.min_wall_m, at_least(0).at_most(100), "m",
              "of map.svg and map.dxf: occupied spots smaller than this are left out")
      .integer("epsg", files.earth.epsg, between(0, 1'000'000), "",
               "of map.tif: the projected coordinate system, in metres; 0: the map's own")
      .number("origin_easting_m", files.earth.easting_m, between(-1e9, 1e9), "m",
              "of map.tif: where the map's origin lies in that system")
      .number("origin_northing_m", files.earth.northing_m, between(-1e9, 1e9), "m", "the same to the north")
      .angle_deg("origin_heading_deg", files.earth.heading_rad, between(-360, 360),
                 "of map.tif: where the map's x axis points, counter-clockwise from east");
}

}  // namespace psi_slam
