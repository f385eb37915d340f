// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace psi_slam {

/// Where the squares are in the tables.
struct BoundLayout {
  int phases = 0;      ///< planes of a table along each axis: half a stride
  int log_phases = 0;  ///< binary logarithm of `phases`
  int columns = 0;     ///< blocks of zeros before each row of a plane
  int rows = 0;        ///< rows of zeros before each plane
  int plane_columns = 0;
  int plane_rows = 0;
  std::uint32_t row_bytes = 0;
  std::uint32_t plane_bytes = 0;
  std::uint32_t table_bytes = 0;

  /// Returns the offset of the square that begins at half cell (x, y) and has sides of `half_cells`. Points
  /// that move by up to a stride need sides from half a stride to one stride + 1. Returns -1 if a window of
  /// `window_columns` x `window_rows` blocks that begins at this square contains no scores. Always
  /// inlined, because kernels for other instruction sets use it.
  __attribute__((always_inline)) std::int32_t offset(int x, int y, int half_cells, int window_columns,
                                                     int window_rows) const {
    const int column = x >> log_phases;
    const int row = y >> log_phases;
    const bool may_score = (column + window_columns > 0) & (column < plane_columns) &
                           (row + window_rows > 0) & (row < plane_rows);
    const int plane = ((y & (phases - 1)) << log_phases) + (x & (phases - 1));
    // Unsigned numbers may overflow where no block has scores.
    const std::uint32_t place = static_cast<std::uint32_t>(half_cells - phases) * table_bytes +
                                static_cast<std::uint32_t>(plane) * plane_bytes +
                                static_cast<std::uint32_t>(rows + row) * row_bytes +
                                static_cast<std::uint32_t>(columns + column);
    return may_score ? static_cast<std::int32_t>(place) : -1;
  }
};

}  // namespace psi_slam
