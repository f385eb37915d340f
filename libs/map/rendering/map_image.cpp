// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/map_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "base/portable_math.h"
#include "map/rendering/picture_ink.h"
#include "map/rendering/png_bytes.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

Pixel mixed(const Pixel& a, const Pixel& b, double share_of_b) {
  Pixel result;
  for (int i = 0; i < 4; ++i) result[i] = cv::saturate_cast<std::uint8_t>(a[i] + (b[i] - a[i]) * share_of_b);
  return result;
}

/// Numbers of cells of a block.
struct BlockCount {
  int occupied = 0;
  int free = 0;
};

bool operator==(const BlockCount& a, const BlockCount& b) {
  return a.occupied == b.occupied && a.free == b.free;
}

/// Counts the cells of the block of side x side cells that begins at (x_begin, y_begin).
BlockCount count_block(const COccupancyGridMap2D& grid, int x_begin, int y_begin, int side) {
  BlockCount count;
  const int x_end = std::min(x_begin + side, static_cast<int>(grid.getSizeX()));
  const int y_end = std::min(y_begin + side, static_cast<int>(grid.getSizeY()));
  for (int y = std::max(y_begin, 0); y < y_end; ++y) {
    const auto* row = grid.getRow(y);
    for (int x = std::max(x_begin, 0); x < x_end; ++x) {
      count.occupied += is_occupied(row[x]) ? 1 : 0;
      count.free += is_free(row[x]) ? 1 : 0;
    }
  }
  return count;
}

/// Returns the colour of the pixel that shows a block of side x side cells. A wall of one cell that crosses
/// the block is as dark as a thick wall.
Pixel block_colour(const BlockCount& count, int side, const Pixel& unknown) {
  const int open = side * side - count.occupied;
  const Pixel ground =
      open == 0 ? kFreeInk : mixed(unknown, kFreeInk, static_cast<double>(count.free) / open);
  return mixed(ground, kWallInk, std::min(1.0, static_cast<double>(count.occupied) / side));
}

/// The part of a grid that a picture shows, before it is enlarged.
struct ShownPart : PicturePlace {
  int x_begin = 0;  ///< column of the first cell
  int y_end = 0;    ///< row after the last cell
  int cells_a_pixel = 1;
};

ShownPart shown_part(const COccupancyGridMap2D& grid, const MapPictureOptions& options) {
  const auto cell_m = static_cast<double>(grid.getResolution());
  const SeenCells seen = seen_cells(grid);
  const int margin = static_cast<int>(std::lround(options.margin_m / cell_m));
  ShownPart part;
  part.x_begin = seen.x_begin - margin;
  part.y_end = seen.y_end + margin;
  const int width = seen.x_end + margin - part.x_begin;
  const int height = part.y_end - (seen.y_begin - margin);
  part.cells_a_pixel =
      std::max(1, (std::max(width, height) + options.max_side_px - 1) / std::max(1, options.max_side_px));
  part.width_px = (width + part.cells_a_pixel - 1) / part.cells_a_pixel;
  part.height_px = (height + part.cells_a_pixel - 1) / part.cells_a_pixel;
  part.resolution_m = cell_m * part.cells_a_pixel;
  part.x_min_m = static_cast<double>(grid.getXMin()) + part.x_begin * cell_m;
  part.y_max_m = static_cast<double>(grid.getYMin()) + part.y_end * cell_m;
  return part;
}

/// Draws each cell as a pixel, into an image of the size of `part` with three or four channels.
void draw_cells(const COccupancyGridMap2D& grid, const ShownPart& part, const Pixel& unknown,
                cv::Mat& image) {
  const int channels = image.channels();
  for (int row = 0; row < image.rows; ++row) {
    const int y = part.y_end - 1 - row;
    const bool is_within = y >= 0 && y < static_cast<int>(grid.getSizeY());
    const COccupancyGridMap2D::cellType* cells = is_within ? grid.getRow(y) : nullptr;
    std::uint8_t* pixel = image.ptr(row);
    for (int column = 0; column < image.cols; ++column, pixel += channels) {
      const int x = part.x_begin + column;
      const Pixel* colour = &unknown;
      if (is_within && x >= 0 && x < static_cast<int>(grid.getSizeX()))
        colour = is_occupied(cells[x]) ? &kWallInk : is_free(cells[x]) ? &kFreeInk : &unknown;
      std::copy_n(colour->val, channels, pixel);
    }
  }
}

/// Draws each block of cells as a pixel. The arguments are those of draw_cells().
void draw_blocks(const COccupancyGridMap2D& grid, const ShownPart& part, const Pixel& unknown,
                 cv::Mat& image) {
  const int channels = image.channels();
  const int side = part.cells_a_pixel;
  BlockCount last;  // neighbours are mostly equal, so their colour is computed once
  Pixel colour = block_colour(last, side, unknown);
  for (int row = 0; row < image.rows; ++row) {
    std::uint8_t* pixel = image.ptr(row);
    for (int column = 0; column < image.cols; ++column, pixel += channels) {
      const BlockCount count =
          count_block(grid, part.x_begin + column * side, part.y_end - (row + 1) * side, side);
      if (!(count == last)) colour = block_colour(count, side, unknown);
      last = count;
      std::copy_n(colour.val, channels, pixel);
    }
  }
}

void draw(const COccupancyGridMap2D& grid, const ShownPart& part, const Pixel& unknown, cv::Mat& image) {
  (part.cells_a_pixel == 1 ? draw_cells : draw_blocks)(grid, part, unknown, image);
}

}  // namespace

double scale_bar_m(double width_m, double resolution_m) {
  const double longest_m = std::max(width_m / 5, resolution_m);
  const double power_m = portable::pow(10, std::floor(portable::log10(longest_m)));
  for (const double digit : {5.0, 2.0})
    if (digit * power_m <= longest_m) return digit * power_m;
  return power_m;
}

void draw_scale_bar(cv::Mat& image, const ScaleBarPlace& place, double bar_m, double resolution_m) {
  const int unit = place.unit;
  const int bar_px = static_cast<int>(std::lround(bar_m / resolution_m));
  const cv::Scalar ink = kWallInk;
  const int thick = std::max(1, unit / 4);
  cv::rectangle(image, {place.left, place.middle - thick / 2, bar_px, thick}, ink, cv::FILLED);
  for (const int end : {place.left, place.left + bar_px - thick})
    cv::rectangle(image, {end, place.middle - unit / 2, thick, unit}, ink, cv::FILLED);
  const std::string label = fixed_text(bar_m, bar_m < 1 ? 2 : 0) + " m";
  cv::putText(image, label, {place.left + bar_px + unit, place.middle + unit / 2}, cv::FONT_HERSHEY_DUPLEX,
              unit / 15.0, ink, std::max(1, unit / 10), cv::LINE_AA);
}

SeenCells seen_cells(const COccupancyGridMap2D& grid) {
  const auto width = static_cast<int>(grid.getSizeX());
  const auto height = static_cast<int>(grid.getSizeY());
  SeenCells seen{width, 0, height, 0, 0, 0};
  for (int y = 0; y < height; ++y) {
    const auto* row = grid.getRow(y);
    int occupied = 0;
    int free = 0;
    for (int x = 0; x < width; ++x) {
      occupied += is_occupied(row[x]) ? 1 : 0;
      free += is_free(row[x]) ? 1 : 0;
    }
    if (occupied + free == 0) continue;
    seen.occupied += static_cast<std::size_t>(occupied);
    seen.free += static_cast<std::size_t>(free);
    const auto is_seen = [&](int x) { return is_occupied(row[x]) || is_free(row[x]); };
    int first = 0;
    while (!is_seen(first)) ++first;
    int last = width - 1;
    while (!is_seen(last)) --last;
    seen.x_begin = std::min(seen.x_begin, first);
    seen.x_end = std::max(seen.x_end, last + 1);
    seen.y_begin = std::min(seen.y_begin, y);
    seen.y_end = y + 1;
  }
  if (seen.x_end == 0) return {0, width, 0, height, 0, 0};
  return seen;
}

MapRaster map_raster(const COccupancyGridMap2D& grid, const MapPictureOptions& options) {
  const ShownPart part = shown_part(grid, options);
  MapRaster raster{part, {}};
  raster.pixels.resize(sizeof(Pixel) * static_cast<std::size_t>(part.width_px) *
                       static_cast<std::size_t>(part.height_px));
  cv::Mat image(part.height_px, part.width_px, CV_8UC4, raster.pixels.data());
  draw(grid, part, options.transparent_unknown ? kTransparentInk : kUnknownInk, image);
  return raster;
}

// Large maps take hundreds of megabytes, so the image is not copied before it is encoded.
MapPicture map_picture(const COccupancyGridMap2D& grid, const MapPictureOptions& options) {
  const ShownPart part = shown_part(grid, options);
  const int longer = std::max(part.width_px, part.height_px);
  const int pixels_a_cell =
      part.cells_a_pixel > 1 ? 1 : std::max(1, (options.min_side_px + longer - 1) / longer);

  MapPicture picture{part, {}};
  picture.resolution_m = part.resolution_m / pixels_a_cell;
  picture.width_px = part.width_px * pixels_a_cell;
  const int height_px = part.height_px * pixels_a_cell;
  const int unit = std::max(6, std::max(picture.width_px, height_px) / 160);
  picture.height_px = height_px + (options.scale_bar ? 5 * unit : 0);

  const Pixel& unknown = options.transparent_unknown ? kTransparentInk : kUnknownInk;
  const int type = options.transparent_unknown ? CV_8UC4 : CV_8UC3;
  cv::Mat image(picture.height_px, picture.width_px, type);
  cv::Mat map = image.rowRange(0, height_px);
  if (pixels_a_cell > 1) {
    cv::Mat small(part.height_px, part.width_px, type);
    draw(grid, part, unknown, small);
    cv::resize(small, map, map.size(), 0, 0, cv::INTER_NEAREST);
  } else {
    draw(grid, part, unknown, map);
  }
  if (options.scale_bar) {
    image.rowRange(height_px, image.rows).setTo(cv::Scalar(unknown));
    const double bar_m = scale_bar_m(picture.width_px * picture.resolution_m, picture.resolution_m);
    draw_scale_bar(image, {2 * unit, height_px + 5 * unit / 2, unit}, bar_m, picture.resolution_m);
  }
  picture.png = png_bytes(std::move(image));
  return picture;
}

void write_map_image(const std::filesystem::path& path, const COccupancyGridMap2D& grid,
                     const MapPictureOptions& options) {
  write_text_atomically(path, map_picture(grid, options).png);
}

}  // namespace psi_slam
