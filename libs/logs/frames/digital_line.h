// SPDX-License-Identifier: BSD-3-Clause
// The cells that a line crosses in a grid, and those that the lines of a scan cross that were not crossed
// before.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace psi_slam {

/// One cell for each step along the longer axis of a line. The position across is a fixed-point number, so
/// that all machines choose the same cells.
struct DigitalLine {
  static constexpr int kFractionBits = 32;

  std::int64_t steps = 0;          ///< number of cells
  std::int64_t first = 0;          ///< index of the first cell at position 0 across
  std::int64_t along_stride = 0;   ///< from one step to the next
  std::int64_t across_stride = 0;  ///< from one position across to the next
  std::int64_t across = 0;         ///< position across at the first cell
  std::int64_t across_step = 0;    ///< increment of `across` by each step
  std::size_t direction = 0;       ///< 0 to 3: longer axis and sense of the line
};

/// Calls `visit` with the index of cells of a line. `visit` returns how many cells to go on, at least 1.
template <class Visit>
void leap_line(const DigitalLine& line, const Visit& visit) {
  std::int64_t index = line.first;
  std::int64_t across = line.across;
  for (std::int64_t i = line.steps; i > 0;) {
    const std::int64_t steps = visit(index + (across >> DigitalLine::kFractionBits) * line.across_stride);
    i -= steps;
    index += steps * line.along_stride;
    across += steps * line.across_step;
  }
}

/// Visits the cells along several lines that start at one point. Visits each cell only once, although
/// neighbouring lines cross the same cells near that point.
class LineFan {
 public:
  void clear() {
    for (auto& cells : crossed_) cells.clear();
  }

  /// Calls `visit` with the index of each cell of a line, except for most of the cells that another line
  /// crossed since clear(). A cell may be visited again.
  template <class Visit>
  void walk(const DigitalLine& line, const Visit& visit) {
    std::vector<std::int64_t>& crossed = crossed_[line.direction];
    const auto steps = static_cast<std::size_t>(line.steps);
    const std::size_t known = std::min(steps, crossed.size());
    if (steps > crossed.size()) crossed.resize(steps);
    // A local copy, because a write of a cell could change the line as far as the compiler knows.
    DigitalLine here = line;
    std::int64_t* const last = crossed.data();
    for (std::size_t i = 0; i < steps; ++i) {
      const std::int64_t index =
          here.first + (here.across >> DigitalLine::kFractionBits) * here.across_stride;
      if (i >= known || last[i] != index) {
        last[i] = index;
        visit(index);
      }
      here.first += here.along_stride;
      here.across += here.across_step;
    }
  }

 private:
  std::array<std::vector<std::int64_t>, 4> crossed_;  ///< by direction: cell of the last line at each step
};

/// Returns Bresenham's line from a cell to another one, without the latter, in a grid whose rows are `stride`
/// cells apart. Exact for lines of up to 46,000 cells; longer ones may have the cell beside.
inline DigitalLine bresenham_line(int x0, int y0, int x1, int y1, std::int64_t stride) {
  const std::int64_t dx = std::abs(x1 - x0);
  const std::int64_t dy = std::abs(y1 - y0);
  const std::int64_t step_x = x1 > x0 ? 1 : -1;
  const std::int64_t step_y = y1 > y0 ? stride : -stride;
  const bool is_steep = dy > dx;
  const std::int64_t along = std::max(dx, dy);
  DigitalLine line;
  if (along == 0) return line;
  line.steps = along;
  line.first = x0 + y0 * stride;
  line.along_stride = is_steep ? step_y : step_x;
  line.across_stride = is_steep ? step_x : step_y;
  // At step k, Bresenham's line is floor((2 k across + along - 1) / (2 along)) cells across. Both terms are
  // rounded up.
  const auto rounded_up = [&](std::int64_t numerator) { return (numerator + along - 1) / along; };
  line.across = rounded_up((along - 1) << (DigitalLine::kFractionBits - 1));
  line.across_step = rounded_up(std::min(dx, dy) << DigitalLine::kFractionBits);
  line.direction = (is_steep ? 2U : 0U) + (line.along_stride > 0 ? 0U : 1U);
  return line;
}

}  // namespace psi_slam
