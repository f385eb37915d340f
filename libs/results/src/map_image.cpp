// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/results/map_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "psi_slam/base/atomic_file.h"
#include "psi_slam/base/user_error.h"
#include "psi_slam/results/number_text.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using Pixel = cv::Vec4b;  // blue, green, red, opacity

const Pixel kWall{38, 28, 22, 255};
const Pixel kFree{255, 255, 255, 255};
const Pixel kUnknown{232, 229, 226, 255};
const Pixel kTransparent{255, 255, 255, 0};

// The log-odds beyond which map_server calls a cell occupied or free.
bool is_occupied(COccupancyGridMap2D::cellType cell) {
  return COccupancyGridMap2D::l2p(cell) < 0.35F;
}
bool is_free(COccupancyGridMap2D::cellType cell) {
  return COccupancyGridMap2D::l2p(cell) > 0.804F;
}

Pixel mixed(const Pixel& a, const Pixel& b, double share_of_b) {
  Pixel result;
  for (int i = 0; i < 4; ++i) result[i] = cv::saturate_cast<std::uint8_t>(a[i] + (b[i] - a[i]) * share_of_b);
  return result;
}

/// The cells that one pixel shows.
struct Block {
  int cells = 0;
  int free = 0;
  int occupied = 0;
};

Block block_at(const COccupancyGridMap2D& grid, int x_begin, int y_begin, int side) {
  Block block;
  const int x_end = std::min(x_begin + side, static_cast<int>(grid.getSizeX()));
  const int y_end = std::min(y_begin + side, static_cast<int>(grid.getSizeY()));
  for (int y = std::max(y_begin, 0); y < y_end; ++y) {
    const auto* row = grid.getRow(y);
    for (int x = std::max(x_begin, 0); x < x_end; ++x) {
      block.free += is_free(row[x]) ? 1 : 0;
      block.occupied += is_occupied(row[x]) ? 1 : 0;
    }
  }
  block.cells = side * side;
  return block;
}

/// A wall one cell thin that crosses the block is as dark as a thick one.
Pixel colour(const Block& block, int side, const Pixel& unknown) {
  const int open = block.cells - block.occupied;
  const Pixel ground = open == 0 ? kFree : mixed(unknown, kFree, static_cast<double>(block.free) / open);
  return mixed(ground, kWall, std::min(1.0, static_cast<double>(block.occupied) / side));
}

/// The raster's own pixels.
cv::Mat image_of(MapRaster& raster) {
  return {raster.height_px, raster.width_px, CV_8UC4, raster.pixels.data()};
}

/// 1, 2 or 5 times a power of ten, at most `length_m`.
double round_length(double length_m) {
  const double power = std::pow(10, std::floor(std::log10(length_m)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= length_m) return digit * power;
  return power;
}

void add_scale_bar(cv::Mat& image, double resolution_m, const Pixel& ground) {
  const int unit = std::max(6, std::max(image.cols, image.rows) / 160);
  const double bar_m = round_length(std::max(image.cols * resolution_m / 5, resolution_m));
  const int bar_px = static_cast<int>(std::lround(bar_m / resolution_m));
  const int top = image.rows;
  cv::copyMakeBorder(image, image, 0, 5 * unit, 0, 0, cv::BORDER_CONSTANT,
                     cv::Scalar(ground[0], ground[1], ground[2], ground[3]));
  const cv::Scalar ink(kWall[0], kWall[1], kWall[2], kWall[3]);
  const int left = 2 * unit;
  const int middle = top + 5 * unit / 2;
  const int thick = std::max(1, unit / 4);
  cv::rectangle(image, {left, middle - thick / 2, bar_px, thick}, ink, cv::FILLED);
  for (const int end : {left, left + bar_px - thick})
    cv::rectangle(image, {end, middle - unit / 2, thick, unit}, ink, cv::FILLED);
  const double font_scale = unit / 15.0;
  const std::string label = fixed_text(bar_m, bar_m < 1 ? 2 : 0) + " m";
  cv::putText(image, label, {left + bar_px + unit, middle + unit / 2}, cv::FONT_HERSHEY_DUPLEX, font_scale,
              ink, std::max(1, unit / 10), cv::LINE_AA);
}

std::string png_bytes(const cv::Mat& image, bool with_opacity) {
  cv::Mat encoded = image;
  if (!with_opacity) cv::cvtColor(image, encoded, cv::COLOR_BGRA2BGR);
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", encoded, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9}))
    throw SystemFailure("cannot make a PNG picture of the map");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

SeenCells seen_cells(const COccupancyGridMap2D& grid) {
  const auto width = static_cast<int>(grid.getSizeX());
  const auto height = static_cast<int>(grid.getSizeY());
  SeenCells seen{width, 0, height, 0, 0, 0};
  for (int y = 0; y < height; ++y) {
    const auto* row = grid.getRow(y);
    for (int x = 0; x < width; ++x) {
      const bool occupied = is_occupied(row[x]);
      if (!occupied && !is_free(row[x])) continue;
      ++(occupied ? seen.occupied : seen.free);
      seen.x_begin = std::min(seen.x_begin, x);
      seen.x_end = std::max(seen.x_end, x + 1);
      seen.y_begin = std::min(seen.y_begin, y);
      seen.y_end = y + 1;
    }
  }
  if (seen.x_end == 0) return {0, width, 0, height, 0, 0};
  return seen;
}

MapRaster map_raster(const COccupancyGridMap2D& grid, const MapPictureOptions& options) {
  const auto cell_m = static_cast<double>(grid.getResolution());
  const SeenCells seen = seen_cells(grid);
  const int margin = static_cast<int>(std::lround(options.margin_m / cell_m));
  const int x_begin = seen.x_begin - margin;
  const int y_end = seen.y_end + margin;
  const int width = seen.x_end + margin - x_begin;
  const int height = y_end - (seen.y_begin - margin);
  const int cells_a_pixel =
      std::max(1, (std::max(width, height) + options.max_side_px - 1) / std::max(1, options.max_side_px));

  const Pixel& unknown = options.transparent_unknown ? kTransparent : kUnknown;
  MapRaster raster;
  raster.width_px = (width + cells_a_pixel - 1) / cells_a_pixel;
  raster.height_px = (height + cells_a_pixel - 1) / cells_a_pixel;
  raster.resolution_m = cell_m * cells_a_pixel;
  raster.x_min_m = static_cast<double>(grid.getXMin()) + x_begin * cell_m;
  raster.y_max_m = static_cast<double>(grid.getYMin()) + y_end * cell_m;
  raster.pixels.resize(sizeof(Pixel) * static_cast<std::size_t>(raster.width_px) *
                       static_cast<std::size_t>(raster.height_px));
  cv::Mat image = image_of(raster);
  for (int row = 0; row < image.rows; ++row) {
    auto* pixels = image.ptr<Pixel>(row);
    for (int column = 0; column < image.cols; ++column)
      pixels[column] = colour(
          block_at(grid, x_begin + column * cells_a_pixel, y_end - (row + 1) * cells_a_pixel, cells_a_pixel),
          cells_a_pixel, unknown);
  }
  return raster;
}

MapPicture map_picture(const COccupancyGridMap2D& grid, const MapPictureOptions& options) {
  MapRaster raster = map_raster(grid, options);
  cv::Mat image = image_of(raster);
  const int longer = std::max(image.cols, image.rows);
  const bool reduced = raster.resolution_m > 1.5 * static_cast<double>(grid.getResolution());
  const int pixels_a_cell = reduced ? 1 : std::max(1, (options.min_side_px + longer - 1) / longer);
  if (pixels_a_cell > 1) cv::resize(image, image, {}, pixels_a_cell, pixels_a_cell, cv::INTER_NEAREST);

  MapPicture picture;
  picture.resolution_m = raster.resolution_m / pixels_a_cell;
  const Pixel& unknown = options.transparent_unknown ? kTransparent : kUnknown;
  if (options.scale_bar) add_scale_bar(image, picture.resolution_m, unknown);
  picture.png = png_bytes(image, options.transparent_unknown);
  picture.width_px = image.cols;
  picture.height_px = image.rows;
  picture.x_min_m = raster.x_min_m;
  picture.y_max_m = raster.y_max_m;
  return picture;
}

void write_map_image(const std::filesystem::path& path, const COccupancyGridMap2D& grid,
                     const MapPictureOptions& options) {
  write_text_atomically(path, map_picture(grid, options).png);
}

}  // namespace psi_slam
