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

#include "matching/bound_layout.h"
#include "matching/cell.h"

namespace psi_slam {

class ScoreLevel;

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
