// SPDX-License-Identifier: BSD-3-Clause
// The grid map as a picture for people: dark walls, white free space, unknown space light grey or
// transparent.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace psi_slam {

/// True for walls and free space respectively, by the thresholds of map_server.
inline bool is_occupied(mrpt::maps::COccupancyGridMap2D::cellType cell) {
  return mrpt::maps::COccupancyGridMap2D::l2p(cell) < 0.35F;
}
inline bool is_free(mrpt::maps::COccupancyGridMap2D::cellType cell) {
  return mrpt::maps::COccupancyGridMap2D::l2p(cell) > 0.804F;
}

/// The part of a grid that was seen: cells [x_begin, x_end) x [y_begin, y_end).
struct SeenCells {
  int x_begin = 0;
  int x_end = 0;
  int y_begin = 0;
  int y_end = 0;
  std::size_t free = 0;      ///< number of free cells
  std::size_t occupied = 0;  ///< number of walls
};

/// Returns the smallest rectangle with all cells seen, or the whole grid if none was seen.
SeenCells seen_cells(const mrpt::maps::COccupancyGridMap2D& grid);

struct MapPictureOptions {
  int max_side_px = 6000;  ///< larger maps are reduced; walls of one cell stay visible
  int min_side_px = 1200;  ///< smaller maps are enlarged by a whole number of pixels per cell
  double margin_m = 0.5;   ///< of unknown space around everything seen
  bool transparent_unknown = false;
  bool scale_bar = true;  ///< in a strip below the map
};

/// A rectangle in the map's frame.
struct MapRectangle {
  double x_min_m = 0;
  double x_max_m = 0;
  double y_min_m = 0;
  double y_max_m = 0;

  double width_m() const { return x_max_m - x_min_m; }
  double height_m() const { return y_max_m - y_min_m; }
};

/// Size of a picture and its place in the map. (x_min_m, y_max_m) is the upper left corner.
struct PicturePlace {
  int width_px = 0;
  int height_px = 0;
  double x_min_m = 0;
  double y_max_m = 0;
  double resolution_m = 0;  ///< side of a pixel in the map

  MapRectangle rectangle() const {
    return {x_min_m, x_min_m + width_px * resolution_m, y_max_m - height_px * resolution_m, y_max_m};
  }
};

/// A picture as a file. Its height includes the strip of the scale bar.
struct MapPicture : PicturePlace {
  std::string png;  ///< contents of a PNG file
};

/// A picture as plain pixels, for textures.
struct MapRaster : PicturePlace {
  std::vector<std::uint8_t> pixels;  ///< blue, green, red, opacity; row by row from the upper left
};

/// Draws the part of the grid that was seen, with its margin, reduced to `max_side_px` but never enlarged,
/// without scale bar.
MapRaster map_raster(const mrpt::maps::COccupancyGridMap2D& grid, const MapPictureOptions& options);

/// Draws the part of the grid that was seen. Equal grids give equal bytes. Throws SystemFailure if the
/// picture cannot be encoded.
MapPicture map_picture(const mrpt::maps::COccupancyGridMap2D& grid, const MapPictureOptions& options = {});

/// Writes `map_picture` atomically. Throws SystemFailure if the file cannot be written.
void write_map_image(const std::filesystem::path& path, const mrpt::maps::COccupancyGridMap2D& grid,
                     const MapPictureOptions& options = {});

}  // namespace psi_slam
