// SPDX-License-Identifier: BSD-3-Clause
#include "gui/raster_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

constexpr int kMostLevels = 16;
constexpr double kTolerance = 1e-6;  // relative; a view that fits the raster exactly needs no further level

/// Opacity times darkness of a pixel. An opaque white pixel has more ink than a transparent one.
int ink(const std::uint8_t* pixel) {
  constexpr int kBrighterThanWhite = 3 * 255 + 1;
  return pixel[3] * (kBrighterThanWhite - pixel[0] - pixel[1] - pixel[2]);
}

}  // namespace

int raster_level(double resolution_m, double pixel_m) {
  if (!(pixel_m > 0) || !(resolution_m > 0)) return 0;
  const double level = std::ceil(portable::log2(pixel_m / resolution_m) - kTolerance);
  return static_cast<int>(std::clamp(level, 0.0, static_cast<double>(kMostLevels)));
}

MapRaster half_raster(const MapRaster& raster) {
  constexpr std::size_t kChannels = 4;
  MapRaster half;
  half.width_px = (raster.width_px + 1) / 2;
  half.height_px = (raster.height_px + 1) / 2;
  half.x_min_m = raster.x_min_m;
  half.y_max_m = raster.y_max_m;
  half.resolution_m = 2 * raster.resolution_m;
  half.pixels.resize(kChannels * static_cast<std::size_t>(half.width_px) *
                     static_cast<std::size_t>(half.height_px));
  const auto pixel = [&](int row, int column) {
    const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(raster.width_px) +
                    static_cast<std::size_t>(column);
    return &raster.pixels[kChannels * at];
  };
  std::uint8_t* to = half.pixels.data();
  for (int row = 0; row < raster.height_px; row += 2) {
    const int below = std::min(row + 1, raster.height_px - 1);
    for (int column = 0; column < raster.width_px; column += 2, to += kChannels) {
      const int beside = std::min(column + 1, raster.width_px - 1);
      const std::array<const std::uint8_t*, 4> block{pixel(row, column), pixel(row, beside),
                                                     pixel(below, column), pixel(below, beside)};
      const std::uint8_t* const darkest = *std::max_element(
          block.begin(), block.end(), [](const auto* a, const auto* b) { return ink(a) < ink(b); });
      std::copy_n(darkest, kChannels, to);
    }
  }
  return half;
}

}  // namespace psi_slam
