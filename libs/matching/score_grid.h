// SPDX-License-Identifier: BSD-3-Clause
// The score grid M of equation 1: for each cell of a local map, the probability that a scan point falls
// there. A max-pooled pyramid of the grid bounds the response of whole blocks of poses (Olson 2009; Hess et
// al. 2016), for the coarse and genetic searches.
//
// The memory layout serves the inner loop of the matcher, which sums runs of neighbouring cells for all
// points of a scan. It has one byte per cell, contiguous rows, and a margin around the grid, so runs need no
// bounds check.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "matching/bound_tables.h"

namespace psi_slam {

/// One level of the pyramid. Cell (x, y) of a level with `stride_cells` = s > 1 holds the largest score among
/// the finest cells [x s, (x + 2) s) x [y s, (y + 2) s); for s = 1, it holds the score. The factor 2 is
/// needed because s shifts of an arbitrary point reach into two aligned blocks. A level takes 1 / s^2 of the
/// memory of the finest level.
class ScoreLevel {
 public:
  /// Width of the margin on every side, in cells. It holds zeros, except column -1 and row -1 of the pyramid
  /// levels.
  static constexpr int kMargin = 16;
  /// Bytes after the last row, for vector loads that read past a run.
  static constexpr int kRunPadding = 64;

  ScoreLevel() = default;
  ScoreLevel(int width, int height, int stride_cells);

  int width() const { return width_; }
  int height() const { return height_; }
  int stride_cells() const { return stride_cells_; }
  /// Number of bytes from a cell to the cell at y + 1.
  std::ptrdiff_t row_bytes() const { return row_bytes_; }

  /// Returns the score of a cell, 0 .. 255; 0 outside the grid and its margin.
  std::uint8_t at(int x, int y) const { return inside(x, y) ? *cell(x, y) : std::uint8_t{0}; }
  /// Returns whether cell(x, y) is valid: inside the grid or its margin.
  bool inside(int x, int y) const {
    return x >= -kMargin && x < width_ + kMargin && y >= -kMargin && y < height_ + kMargin;
  }
  const std::uint8_t* cell(int x, int y) const { return bytes_.data() + index(x, y); }
  std::uint8_t* cell(int x, int y) { return bytes_.data() + index(x, y); }
  std::size_t memory_bytes() const { return bytes_.size(); }

  /// Moves all cells out, with margin and padding. The level then has no cells until give_bytes().
  std::vector<std::uint8_t> take_bytes() { return std::move(bytes_); }
  void give_bytes(std::vector<std::uint8_t> bytes) { bytes_ = std::move(bytes); }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>((y + kMargin) * row_bytes_ + x + kMargin);
  }
  int width_ = 0;
  int height_ = 0;
  int stride_cells_ = 1;
  std::ptrdiff_t row_bytes_ = 0;
  std::vector<std::uint8_t> bytes_;
};

/// The finest grid and its pyramid, in the frame of its local map. Score 255 is probability 1.
class ScoreGrid {
 public:
  /// Strides of the pyramid levels in finest cells, from fine to coarse.
  static constexpr std::array<int, 2> kStrides = {2, 8};
  /// Strides of the tables of bounds.
  static constexpr std::array<int, 1> kBoundStrides = {4};
  static constexpr int kBoundedBlocks = 32;

  ScoreGrid() = default;
  /// Makes a grid of zeros. Cell (0, 0) covers [origin, origin + resolution) on both axes, in metres.
  ScoreGrid(double origin_x_m, double origin_y_m, double resolution_m, int width, int height);

  double origin_x_m() const { return origin_x_m_; }
  double origin_y_m() const { return origin_y_m_; }
  double resolution_m() const { return resolution_m_; }
  const ScoreLevel& finest() const { return finest_; }
  ScoreLevel& finest() { return finest_; }

  /// Returns a grid of the cells [x, x + width) x [y, y + height), without a pyramid. These cells must lie
  /// inside the grid.
  ScoreGrid cropped(int x, int y, int width, int height) const;

  /// Builds the pyramid from the finest level. Call it when the finest level is final.
  void build_pyramid();
  void drop_pyramid() { pyramid_.clear(); }
  bool has_pyramid() const { return !pyramid_.empty(); }
  /// Returns level i of the pyramid, which has stride kStrides[i].
  const ScoreLevel& pyramid(std::size_t i) const { return pyramid_[i]; }

  /// Makes tables of bounds for a grid without scores. Exact searches of windows of at most kBoundedBlocks
  /// blocks along each axis use them; without them, each search makes its own. Throws as BoundTables does.
  void make_bounds();
  /// Takes over the scores of the cells [first, end) into the tables. Call it after each change.
  void update_bounds(Cell first, Cell end);
  /// Returns the tables for blocks of `stride_cells` and windows of columns x rows blocks; null if there are
  /// none.
  const BoundTables* bounds(int stride_cells, int columns, int rows) const;

  /// Score, divided by 255, and its gradient in 1/m, interpolated between cell centres by Catmull-Rom cubic
  /// splines. Value and gradient are zero outside the grid.
  struct Sample {
    double value;
    double d_dx;
    double d_dy;
  };
  Sample interpolate(double x_m, double y_m) const;

  std::size_t memory_bytes() const;

 private:
  double origin_x_m_ = 0;
  double origin_y_m_ = 0;
  double resolution_m_ = 0.05;
  ScoreLevel finest_;
  std::vector<ScoreLevel> pyramid_;
  std::vector<BoundTables> bounds_;
};

}  // namespace psi_slam
