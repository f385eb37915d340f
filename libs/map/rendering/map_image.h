// SPDX-License-Identifier: BSD-3-Clause
// The grid map as an image for people: dark walls, white free space, unknown space light grey or transparent.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace psi_slam {

/// Cells of MRPT's grid, whose probability to be free grows with the cell. The thresholds are those of ROS's
/// map_server: below 0.35, a cell is occupied, and above 0.804, it is free. As cells, because a comparison of
/// probabilities would call MRPT for each cell.
inline constexpr mrpt::maps::COccupancyGridMap2D::cellType kFirstNotOccupiedCell = -9;
inline constexpr mrpt::maps::COccupancyGridMap2D::cellType kFirstFreeCell = 23;
static_assert(sizeof(mrpt::maps::COccupancyGridMap2D::cellType) == 1);

/// Whether a cell is occupied.
inline bool is_occupied(mrpt::maps::COccupancyGridMap2D::cellType cell) {
  return cell < kFirstNotOccupiedCell;
}
/// Whether a cell is free.
inline bool is_free(mrpt::maps::COccupancyGridMap2D::cellType cell) {
  return cell >= kFirstFreeCell;
}

/// The observed part of a grid: cells [x_begin, x_end) x [y_begin, y_end).
struct SeenCells {
  int x_begin = 0;
  int x_end = 0;
  int y_begin = 0;
  int y_end = 0;
  std::size_t free = 0;      ///< number of free cells
  std::size_t occupied = 0;  ///< number of occupied cells
};

/// Returns the smallest rectangle that contains all free and occupied cells, or the whole grid if there are
/// none.
SeenCells seen_cells(const mrpt::maps::COccupancyGridMap2D& grid);

struct MapPictureOptions {
  /// Largest width and height; larger maps are reduced, but walls of one cell stay visible.
  int max_side_px = 6000;
  /// Smallest length of the longer side. In smaller maps, each cell becomes a whole number of pixels wide.
  int min_side_px = 1200;
  double margin_m = 0.5;  ///< width of the unknown space around the observed part
  bool transparent_unknown = false;
  bool scale_bar = true;  ///< whether to draw a scale bar in a strip below the map
};

/// A rectangle in the map's frame, in metres.
struct MapRectangle {
  double x_min_m = 0;
  double x_max_m = 0;
  double y_min_m = 0;
  double y_max_m = 0;

  double width_m() const { return x_max_m - x_min_m; }
  double height_m() const { return y_max_m - y_min_m; }
};

/// Size of an image and its place in the map's frame. (x_min_m, y_max_m) is the upper left corner.
struct PicturePlace {
  int width_px = 0;
  int height_px = 0;
  double x_min_m = 0;
  double y_max_m = 0;
  double resolution_m = 0;  ///< side length of a pixel in the map

  MapRectangle rectangle() const {
    return {x_min_m, x_min_m + width_px * resolution_m, y_max_m - height_px * resolution_m, y_max_m};
  }
};

/// An image as a PNG file. Its height includes the strip of the scale bar.
struct MapPicture : PicturePlace {
  std::string png;  ///< contents of a PNG file
};

/// An image as plain pixels, for textures.
struct MapRaster : PicturePlace {
  std::vector<std::uint8_t> pixels;  ///< blue, green, red, opacity; row by row from the upper left
};

/// Draws the observed part of the grid with its margin and without scale bar. Reduces larger images to
/// `options.max_side_px`, but never enlarges an image.
MapRaster map_raster(const mrpt::maps::COccupancyGridMap2D& grid, const MapPictureOptions& options);

/// Draws the observed part of the grid. Equal grids give equal bytes. Throws SystemFailure if the image
/// cannot be encoded.
MapPicture map_picture(const mrpt::maps::COccupancyGridMap2D& grid, const MapPictureOptions& options = {});

/// Writes the image of map_picture() atomically. Throws SystemFailure if the file cannot be written.
void write_map_image(const std::filesystem::path& path, const mrpt::maps::COccupancyGridMap2D& grid,
                     const MapPictureOptions& options = {});

}  // namespace psi_slam
