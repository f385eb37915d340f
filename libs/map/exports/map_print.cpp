// SPDX-License-Identifier: BSD-3-Clause
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "map/exports/map_files.h"
#include "map/rendering/map_image.h"
#include "map/rendering/picture_ink.h"
#include "map/rendering/png_bytes.h"

namespace psi_slam {
namespace {

constexpr double kMetresPerInch = 0.0254;
constexpr double kPrintFooter_mm = 14;  // height of the strip below the map, millimetres of paper
constexpr double kMaxPixels = 148e6;    // limits the memory that the picture needs; 2e6 are left for rounding
constexpr double kMaxSide_px = 1e6;     // libpng reads no wider pictures

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 0xff);
  return bytes;
}

/// Inserts the chunk pHYs (pixels per metre of paper) after the header of a PNG file.
std::string with_resolution(std::string png, double pixels_per_metre) {
  constexpr std::size_t kHeaderEnd = 8 + 25;  // the signature and the chunk IHDR
  const std::string pixels =
      big_endian(static_cast<std::uint32_t>(std::max(1L, std::lround(pixels_per_metre))));
  const std::string chunk = "pHYs" + pixels + pixels + '\x01';
  const auto checksum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size())));
  return png.insert(kHeaderEnd, big_endian(9) + chunk + big_endian(checksum));
}

/// Draws an arrow from `from` in a direction counter-clockwise from the x axis, with `name` at the tip.
/// `from` and `length` are in pixels.
void draw_arrow(cv::Mat& image, const cv::Point2d& from, double length, double direction_rad,
                const std::string& name, double px_per_mm) {
  const cv::Scalar ink = kWallInk;
  const cv::Point2d direction(portable::cos(direction_rad), -portable::sin(direction_rad));
  const cv::Point2d tip = from + length * direction;
  const int thick = std::max(1, static_cast<int>(std::lround(0.3 * px_per_mm)));
  cv::arrowedLine(image, from, tip, ink, thick, cv::LINE_AA, 0, 0.25);
  const double font_scale = px_per_mm * 2.5 / 21;  // FONT_HERSHEY_DUPLEX has capitals 21 pixels high
  const cv::Size size = cv::getTextSize(name, cv::FONT_HERSHEY_DUPLEX, font_scale, thick, nullptr);
  const cv::Point2d middle = tip + 2.8 * px_per_mm * direction;
  cv::putText(image, name, middle + cv::Point2d(-size.width / 2.0, size.height / 2.0),
              cv::FONT_HERSHEY_DUPLEX, font_scale, ink, thick, cv::LINE_AA);
}

/// Adds the strip below the map: scale bar on the left, north and axes on the right.
void add_footer(cv::Mat& image, const MapFileOptions& options, double pixels_a_m, double px_per_mm) {
  const int top = image.rows;
  cv::copyMakeBorder(image, image, 0, static_cast<int>(std::lround(kPrintFooter_mm * px_per_mm)), 0, 0,
                     cv::BORDER_CONSTANT, kUnknownInk);
  const int unit = std::max(4, static_cast<int>(std::lround(2.5 * px_per_mm)));
  const int middle = top + static_cast<int>(kPrintFooter_mm / 2 * px_per_mm);
  draw_scale_bar(image, {unit, middle, unit}, scale_bar_m(image.cols / pixels_a_m, 1 / pixels_a_m),
                 1 / pixels_a_m, "  1:" + shortest_text(static_cast<float>(options.print_scale)));
  const cv::Point2d corner(image.cols - 12 * px_per_mm, top + 11 * px_per_mm);
  draw_arrow(image, corner, 6 * px_per_mm, 0, "x", px_per_mm);
  draw_arrow(image, corner, 6 * px_per_mm, M_PI / 2, "y", px_per_mm);
  if (options.earth.epsg == 0) return;
  const double north_rad = M_PI / 2 - options.earth.heading_rad;
  const double length = 5 * px_per_mm;
  const cv::Point2d half(portable::cos(north_rad) * length / 2, -portable::sin(north_rad) * length / 2);
  const cv::Point2d centre(image.cols - 24 * px_per_mm, top + 7 * px_per_mm);
  draw_arrow(image, centre - half, length, north_rad, "N", px_per_mm);
}

}  // namespace

double dpi_that_fits(double width_m, double height_m, const MapFileOptions& options) {
  const double width_in = width_m / (options.print_scale * kMetresPerInch);
  const double height_in = height_m / (options.print_scale * kMetresPerInch);
  const double footer_in = kPrintFooter_mm / 1000 / kMetresPerInch;
  const double fitting_dpi = std::min(std::sqrt(kMaxPixels / (width_in * (height_in + footer_in))),
                                      kMaxSide_px / std::max(width_in, height_in + footer_in));
  // Whole numbers, if there are any that fit.
  return std::min<double>(options.print_dpi, fitting_dpi < 1 ? fitting_dpi : std::floor(fitting_dpi));
}

std::string print_map(const mrpt::maps::COccupancyGridMap2D& grid, const MapFileOptions& options) {
  MapPictureOptions whole;
  whole.max_side_px = std::numeric_limits<int>::max() / 2;
  MapRaster raster = map_raster(grid, whole);
  const double paper_pixels_a_m =
      dpi_that_fits(raster.width_px * raster.resolution_m, raster.height_px * raster.resolution_m, options) /
      kMetresPerInch;
  const double pixels_a_m = paper_pixels_a_m / options.print_scale;
  const auto pixels = [&](int cells) {
    return std::max(1, static_cast<int>(std::lround(cells * raster.resolution_m * pixels_a_m)));
  };
  // In a reduced picture, map_raster() keeps walls of one cell visible.
  if (pixels_a_m * raster.resolution_m < 1) {
    whole.max_side_px = pixels(std::max(raster.width_px, raster.height_px));
    raster = map_raster(grid, whole);
  }
  cv::Mat image(raster.height_px, raster.width_px, CV_8UC4, raster.pixels.data());
  cv::cvtColor(image, image, cv::COLOR_BGRA2BGR);
  cv::resize(image, image, {pixels(raster.width_px), pixels(raster.height_px)}, 0, 0, cv::INTER_NEAREST);
  add_footer(image, options, pixels_a_m, paper_pixels_a_m / 1000);
  return with_resolution(png_bytes(std::move(image)), paper_pixels_a_m);
}

}  // namespace psi_slam
