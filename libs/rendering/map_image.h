// SPDX-License-Identifier: BSD-3-Clause
// The gridmap as a picture for people: walls dark, free space white, the unknown light grey or transparent.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace psi_slam {

struct MapPictureOptions {
  int max_side_px = 6000;  ///< larger maps are reduced, so that walls one cell thin stay to be seen
  int min_side_px = 1200;  ///< smaller maps are enlarged, each cell by the same whole number of pixels
  double margin_m = 0.5;   ///< of unknown space around what was seen
  bool transparent_unknown = false;  ///< for pages with a ground of their own
  bool scale_bar = true;             ///< in a strip of its own below the map
};

/// A picture, and where it lies in the map: pixel (0, 0) is at the upper left.
struct MapPicture {
  std::string png;  ///< the bytes of a PNG file
  int width_px = 0;
  int height_px = 0;  ///< with the strip of the scale bar
  double x_min_m = 0;
  double y_max_m = 0;
  double resolution_m = 0;  ///< a pixel's side in the map
};

/// The same as plain pixels, for textures: four bytes each (blue, green, red, opacity), row by row from the
/// upper left.
struct MapRaster {
  int width_px = 0;
  int height_px = 0;
  double x_min_m = 0;
  double y_max_m = 0;
  double resolution_m = 0;  ///< a pixel's side in the map
  std::vector<std::uint8_t> pixels;
};

/// The part of the grid that was seen, with its margin, reduced to `max_side_px` but not enlarged, without
/// scale bar.
MapRaster map_raster(const mrpt::maps::COccupancyGridMap2D& grid, const MapPictureOptions& options);

/// Draws the part of the grid that was seen. The same grid gives the same bytes.
MapPicture map_picture(const mrpt::maps::COccupancyGridMap2D& grid, const MapPictureOptions& options = {});

/// Writes `map_picture` atomically. Throws SystemFailure when it cannot be written.
void write_map_image(const std::filesystem::path& path, const mrpt::maps::COccupancyGridMap2D& grid,
                     const MapPictureOptions& options = {});

/// The part of a grid that was seen: cells [x_begin, x_end) x [y_begin, y_end); the whole grid where nothing
/// was.
struct SeenCells {
  int x_begin = 0;
  int x_end = 0;
  int y_begin = 0;
  int y_end = 0;
  std::size_t free = 0;
  std::size_t occupied = 0;
};

SeenCells seen_cells(const mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace psi_slam
