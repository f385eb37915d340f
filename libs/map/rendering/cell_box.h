// SPDX-License-Identifier: BSD-3-Clause
// Beams as digital lines. They are walked in a box of cells that depends on their frame alone, so that a
// frame at the same pose touches the same cells in every map.
#pragma once

#include <mrpt/math/TBoundingBox.h>
#include <mrpt/math/TPoint2D.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "logs/frames/digital_line.h"

namespace psi_slam {

/// A box of cells around the rays of a frame. Cell (x, y) of a map begins at x and y times the resolution.
struct CellBox {
  double resolution_m = 0;
  std::int64_t x_min = 0;
  std::int64_t y_min = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;

  /// Returns a point, in metres in the map, in cells relative to the corner of the box.
  mrpt::math::TPoint2D in_cells(const mrpt::math::TPoint2D& point) const {
    return {point.x / resolution_m - static_cast<double>(x_min),
            point.y / resolution_m - static_cast<double>(y_min)};
  }
};

/// Returns a box of all cells of digital lines between points within `bounds`, in metres.
inline CellBox cell_box(const mrpt::math::TBoundingBox& bounds, double resolution_m) {
  constexpr std::int64_t kMargin = 2;  // a digital line may end one cell beside its end point
  const auto cell = [&](double metres) { return std::llround(std::floor(metres / resolution_m)); };
  CellBox box{resolution_m, cell(bounds.min.x) - kMargin, cell(bounds.min.y) - kMargin, 0, 0};
  box.width = cell(bounds.max.x) + kMargin + 1 - box.x_min;
  box.height = cell(bounds.max.y) + kMargin + 1 - box.y_min;
  return box;
}

/// Returns the digital line from `start` to `end`, except the cell of `end`. Both points are in cells and not
/// negative. Rows are `stride` cells apart; index 0 is cell (0, 0). The position across is that of the line
/// at the middle of each step.
inline DigitalLine digital_line(const mrpt::math::TPoint2D& start, const mrpt::math::TPoint2D& end,
                                std::int64_t stride) {
  constexpr auto kOne = static_cast<double>(std::int64_t{1} << DigitalLine::kFractionBits);
  const bool is_steep = std::abs(end.x - start.x) < std::abs(end.y - start.y);
  const auto [along0, across0, along1, across1] =
      is_steep ? std::array{start.y, start.x, end.y, end.x} : std::array{start.x, start.y, end.x, end.y};
  const auto first = static_cast<std::int64_t>(along0);
  const auto last = static_cast<std::int64_t>(along1);
  const std::int64_t sense = last < first ? -1 : 1;
  const double slope = along1 == along0 ? 0 : (across1 - across0) / (along1 - along0);
  DigitalLine line;
  line.steps = std::abs(last - first);
  line.along_stride = is_steep ? sense * stride : sense;
  line.across_stride = is_steep ? 1 : stride;
  line.first = first * (is_steep ? stride : 1);
  line.across = std::llround((across0 + (static_cast<double>(first) + 0.5 - along0) * slope) * kOne);
  line.across_step = std::llround(slope * static_cast<double>(sense) * kOne);
  line.direction = (is_steep ? 2U : 0U) + (sense > 0 ? 0U : 1U);
  return line;
}

}  // namespace psi_slam
