// SPDX-License-Identifier: BSD-3-Clause
// Upper bounds of the sums of whole blocks of poses, for branch and bound. As in Hess et al. 2016, the
// maximum of the scores in a square bounds the score of a point at all shifts of a block. Here the block also
// spans several headings, and the square of a point grows with the distance that the point moves in between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "matching/search_lattice.h"

namespace psi_slam {

/// All blocks of one size in the window of a lattice. A block spans `stride_cells` shifts along x and y, and
/// headings() headings: as many as move no point by much more than a stride. Blocks are numbered by layer
/// (heading), row (y) and column (x) from the lowest pose of the window. Blocks at the end of the window may
/// extend beyond it.
///
/// The tables hold the largest score of every k x k square of half cells, where a half cell is a maximum over
/// 2 x 2 finest cells. Each table is stored as planes: plane (i, j) has the squares whose first half cell is
/// (i, j) modulo half a stride. So the squares of a point in neighbouring blocks are neighbouring bytes.
class BoundLevel {
 public:
  /// Makes the tables. Keeps a reference to the lattice. `stride_cells` is a power of two, at least 4. Throws
  /// std::invalid_argument if the tables take more than 2 GB, as in windows and grids of more than about
  /// 14,000 cells along each axis.
  BoundLevel(const SearchLattice& lattice, int stride_cells);

  int stride_cells() const { return stride_; }
  int headings() const { return headings_; }  ///< number of headings in a layer, a power of two
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int layers() const { return static_cast<int>(layers_.size()); }

  /// Adds the bounds of the blocks [first.x, first.x + width) x [first.y, first.y + height) of a layer to
  /// `bounds`, row by row, `bounds_row` elements apart. The blocks must be in the window. As the sum kernel,
  /// it changes elements up to the next multiple of kSumLanes from `width` on.
  void add_bounds(int layer, Cell first, int width, int height, std::uint32_t* bounds,
                  std::ptrdiff_t bounds_row);

 private:
  // The points that may lie on scores, as offsets of their squares for the first block of the layer.
  struct Layer {
    bool known = false;
    std::vector<std::int32_t> offsets;
  };

  void make_tables(int first_x, int first_y, int end_x, int end_y);
  void make_offsets(int number, Layer& layer) const;

  const SearchLattice& lattice_;
  int stride_;
  int phases_;          // planes of a table along each axis: half a stride
  int log_phases_ = 0;  // binary logarithm of phases_
  int headings_ = 1;
  int columns_;
  int rows_;
  Cell origin_ = {0, 0};  // finest cell at the first half cell of the tables
  int plane_columns_ = 0;
  int plane_rows_ = 0;
  std::ptrdiff_t row_bytes_ = 0;
  std::ptrdiff_t plane_bytes_ = 0;
  std::ptrdiff_t table_bytes_ = 0;
  std::vector<std::uint8_t> tables_;
  std::vector<Layer> layers_;
};

}  // namespace psi_slam
