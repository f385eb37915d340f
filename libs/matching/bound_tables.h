// SPDX-License-Identifier: BSD-3-Clause
// The largest scores of all small squares of a score grid. BoundLevel sums them to upper bounds of the sums
// of whole blocks of poses. Tables of a grid that grows by scans are updated where its scores change.
//
// A table holds the largest score of every k x k square of half cells, where a half cell is a maximum over
// 2 x 2 finest cells. Each table is stored as planes: plane (i, j) has the squares whose first half cell is
// (i, j) modulo half a stride. So the squares of a point in neighbouring blocks are neighbouring bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "matching/cell.h"

namespace psi_slam {

class ScoreLevel;

/// Where the squares are in the tables.
struct BoundLayout {
  int phases = 0;      ///< planes of a table along each axis: half a stride
  int log_phases = 0;  ///< binary logarithm of `phases`
  int columns = 0;     ///< blocks of zeros before each row of a plane
  int rows = 0;        ///< rows of zeros before each plane
  int plane_columns = 0;
  int plane_rows = 0;
  std::int32_t row_bytes = 0;
  std::int32_t plane_bytes = 0;
  std::int32_t table_bytes = 0;

  /// Returns the offset of the square that begins at half cell (x, y), with sides of `half_cells`: half a
  /// stride to one stride + 1, the sizes that points need which move by up to a stride. Returns -1 if no
  /// block of a window of `window_columns` x `window_rows` blocks from this square on has scores. Always
  /// inlined, because kernels for other instruction sets use it.
  __attribute__((always_inline)) std::int32_t offset(int x, int y, int half_cells, int window_columns,
                                                     int window_rows) const {
    const int column = x >> log_phases;
    const int row = y >> log_phases;
    const bool may_score = (column + window_columns > 0) & (column < plane_columns) &
                           (row + window_rows > 0) & (row < plane_rows);
    const int plane = ((y & (phases - 1)) << log_phases) + (x & (phases - 1));
    // Unsigned numbers may overflow where no block has scores.
    const auto times = [](int count, std::int32_t bytes) {
      return static_cast<std::uint32_t>(count) * static_cast<std::uint32_t>(bytes);
    };
    const std::uint32_t place = times(half_cells - phases, table_bytes) + times(plane, plane_bytes) +
                                times(rows + row, row_bytes) + static_cast<std::uint32_t>(columns + column);
    return may_score ? static_cast<std::int32_t>(place) : -1;
  }
};

class BoundTables {
 public:
  /// Makes tables for the cells [first, end) of a level without scores and for blocks of `stride_cells`
  /// shifts, a power of two from 4 on. Zeros surround the tables, as wide as `columns` and `rows` blocks, so
  /// sums over windows of at most this size need no bounds check. Throws std::invalid_argument if the tables
  /// take more than 2 GB, as in windows and grids of more than about 14,000 cells along each axis.
  BoundTables(int stride_cells, Cell first, Cell end, int columns, int rows);

  /// Takes over the scores of the cells [first, end). Cells outside the tables are left out.
  void update(const ScoreLevel& scores, Cell first, Cell end);

  int stride_cells() const { return stride_; }
  const BoundLayout& layout() const { return layout_; }
  std::size_t memory_bytes() const { return bytes_.size(); }

  /// Finest cell at the first half cell of the tables.
  Cell origin() const { return origin_; }

  const std::uint8_t* bytes() const { return bytes_.data(); }

 private:
  void write_smallest_squares(const ScoreLevel& scores, Cell low, Cell high);
  void unite_squares(int table, int i, int j, Cell begin, Cell end);
  std::uint8_t* row_of(int table, int plane_y, int plane_x, int y);

  int stride_;
  int tables_;
  Cell first_;  // the cells that the tables cover: whole half cells
  Cell end_;
  int margin_;  // half cells below the first that still have scores in their squares
  Cell origin_;
  int half_columns_;  // half cells of the tables
  int half_rows_;
  BoundLayout layout_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace psi_slam
