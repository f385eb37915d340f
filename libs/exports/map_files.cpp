// SPDX-License-Identifier: BSD-3-Clause
#include "exports/map_files.h"

#include <cmath>
#include <functional>
#include <system_error>

#include "base/atomic_file.h"
#include "exports/map_drawing_files.h"
#include "exports/map_print.h"
#include "exports/map_server_pair.h"
#include "exports/mrpt_maps.h"
#include "rendering/map_image.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

std::vector<std::vector<mrpt::math::TPose2D>> paths_of(const MappingResult& result) {
  std::vector<std::vector<mrpt::math::TPose2D>> paths;
  for (const FrameSpan& run : runs_of(result)) {
    paths.emplace_back();
    for (std::size_t i = run.begin; i < run.end; ++i) paths.back().push_back(result.frames[i].map_T_robot);
  }
  return paths;
}

MapPrintOptions print_options(const MapFileOptions& options) {
  MapPrintOptions print;
  print.scale = options.print_scale;
  print.dpi = options.print_dpi;
  if (options.earth.epsg != 0) print.north_rad = M_PI / 2 - options.earth.heading_rad;
  return print;
}

}  // namespace

void write_map_files(const fs::path& folder, const MappingResult& result,
                     const mrpt::maps::COccupancyGridMap2D& grid, const MapFileOptions& options) {
  const auto remove = [&](const char* name) {
    std::error_code ignored;
    fs::remove(folder / name, ignored);
  };
  const auto file = [&](bool wanted, const char* name, const std::function<void(const fs::path&)>& write) {
    wanted ? write(folder / name) : remove(name);
  };
  file(options.png, "map.png", [&](const fs::path& path) { write_map_image(path, grid); });
  file(options.ros, "map.yaml", [&](const fs::path& path) { write_map_server_pair(path, grid); });
  if (!options.ros) remove("map.pgm");
  file(options.mrpt, "map.gridmap.gz", [&](const fs::path& path) { write_mrpt_map(path, grid); });
  file(options.mrpt, "map.simplemap.gz",
       [&](const fs::path& path) { write_mrpt_map(path, simple_map(result)); });
  MapDrawing drawing;
  if (options.svg || options.dxf) drawing = draw_map_lines(grid, paths_of(result), options.lines);
  file(options.svg, "map.svg",
       [&](const fs::path& path) { write_text_atomically(path, map_svg(drawing, options.print_scale)); });
  file(options.dxf, "map.dxf", [&](const fs::path& path) { write_text_atomically(path, map_dxf(drawing)); });
  file(options.print, "map_print.png",
       [&](const fs::path& path) { write_text_atomically(path, print_map(grid, print_options(options))); });
  file(options.geotiff, "map.tif", [&](const fs::path& path) { write_geo_tiff(path, grid, options.earth); });
}

}  // namespace psi_slam
