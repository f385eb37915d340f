// SPDX-License-Identifier: BSD-3-Clause
// The cells that a beam crosses. Lines are walked in a box of cells that depends on their frame alone, so
// that a frame at the same pose touches the same cells in every map.
#pragma once

#include <mrpt/math/TBoundingBox.h>
#include <mrpt/math/TPoint2D.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>

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

/// Steps along the longer axis of the line and computes the position across it at the middle of each step.
/// Fixed-point arithmetic makes all machines choose the same cells. `visit` returns how many steps to go on.
template <class Visit>
void leap_along(double along0, double across0, double along1, double across1, std::int64_t along_stride,
                std::int64_t across_stride, Visit visit) {
  constexpr int kFractionBits = 32;
  constexpr double kOne = 4294967296.0;
  const auto first = static_cast<std::int64_t>(along0);
  const auto last = static_cast<std::int64_t>(along1);
  const std::int64_t step = last < first ? -1 : 1;
  const double slope = along1 == along0 ? 0 : (across1 - across0) / (along1 - along0);
  const std::int64_t across_step = std::llround(slope * static_cast<double>(step) * kOne);
  std::int64_t across = std::llround((across0 + (static_cast<double>(first) + 0.5 - along0) * slope) * kOne);
  std::int64_t index = first * along_stride;
  for (std::int64_t i = std::abs(last - first); i > 0;) {
    const std::int64_t steps = visit(index + (across >> kFractionBits) * across_stride);
    i -= steps;
    index += steps * step * along_stride;
    across += steps * across_step;
  }
}

/// Calls `visit` with the index of cells of the digital line from `start` to `end`, except the cell of `end`.
/// `visit` returns how many cells to go on along the line, at least 1. Both points are in cells and not
/// negative. Rows are `stride` cells apart; index 0 is cell (0, 0).
template <class Visit>
void leap_line(const mrpt::math::TPoint2D& start, const mrpt::math::TPoint2D& end, std::int64_t stride,
               Visit visit) {
  if (std::abs(end.x - start.x) >= std::abs(end.y - start.y))
    leap_along(start.x, start.y, end.x, end.y, 1, stride, visit);
  else
    leap_along(start.y, start.x, end.y, end.x, stride, 1, visit);
}

/// Calls `visit` with the index of each cell that leap_line() can reach.
template <class Visit>
void walk_line(const mrpt::math::TPoint2D& start, const mrpt::math::TPoint2D& end, std::int64_t stride,
               Visit visit) {
  leap_line(start, end, stride, [&](std::int64_t index) {
    visit(index);
    return std::int64_t{1};
  });
}

}  // namespace psi_slam
