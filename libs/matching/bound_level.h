// SPDX-License-Identifier: BSD-3-Clause
// Upper bounds of the sums of whole blocks of poses, for branch and bound. As in Hess et al. 2016, the
// maximum of the scores in a square bounds the score of a point at all shifts of a block. Here the block also
// spans several headings, and the square of a point grows with the distance that the point moves in between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "matching/bound_tables.h"
#include "matching/search_lattice.h"

namespace psi_slam {

/// All blocks of one size in the window of a lattice. A block spans `stride_cells` shifts along x and y, and
/// headings() headings: as many as move no point by much more than a stride. Blocks are numbered by layer
/// (heading), row (y) and column (x) from the lowest pose of the window. Blocks at the end of the window may
/// extend beyond it.
class BoundLevel {
 public:
  /// Uses the tables of the lattice's grid if they have this stride and suffice for the window, and makes
  /// tables of the cells that the points can reach otherwise. Keeps a reference to the lattice. Throws as
  /// BoundTables does.
  BoundLevel(const SearchLattice& lattice, int stride_cells);

  int stride_cells() const { return stride_; }
  int headings() const { return headings_; }  ///< number of headings in a layer, a power of two
  /// Number of blocks of `stride_cells` shifts over a window of n steps to each side.
  static int blocks_of(int n, int stride_cells) { return (2 * n + stride_cells) / stride_cells; }

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int layers() const { return static_cast<int>(layers_.size()); }

  /// Adds the bounds of the blocks [first.x, first.x + width) x [first.y, first.y + height) of a layer to
  /// `bounds`, row by row, `bounds_row` elements apart. The blocks must be in the window. Writes in groups of
  /// kSumLanes elements, so it also changes elements from `width` up to the next multiple of kSumLanes.
  void add_bounds(int layer, Cell first, int width, int height, std::uint32_t* bounds,
                  std::ptrdiff_t bounds_row);

 private:
  // The points that may lie on scores, as offsets of their squares for the first block of the layer.
  struct Layer {
    bool known = false;
    std::vector<std::int32_t> offsets;
  };

  const BoundTables& tables() const { return own_tables_ ? *own_tables_ : *grid_tables_; }
  BoundTables make_tables() const;
  void make_offsets(int number, Layer& layer);

  const SearchLattice& lattice_;
  int stride_;
  int headings_ = 1;
  int columns_;
  int rows_;
  const BoundTables* grid_tables_;  // null: the tables are own_tables_
  std::optional<BoundTables> own_tables_;
  double reach_cells_;          // largest distance of a point from the robot
  std::vector<float> x_cells_;  // points in the robot's frame
  std::vector<float> y_cells_;
  std::vector<std::int32_t> squares_;  // offset of each point's square, -1 for a point without scores
  std::vector<Layer> layers_;
};

}  // namespace psi_slam
