// SPDX-License-Identifier: BSD-3-Clause
// The score grid M of equation 1: for each cell of a local map the probability that a scan point falls there,
// and the max-pooled pyramid over it that bounds the response of whole blocks of poses (Olson 2009; Hess et
// al. 2016).
//
// Memory is laid out for the matcher's inner loop, which adds up, for all points of a scan, runs of
// *neighbouring* cells: one byte a cell, rows contiguous, a margin of zeros around so that no run needs a
// bounds check.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace psi_slam {

/// The largest whole number not above `value`, which must fit an int: std::floor is a call of the library on
/// processors that the build does not demand more of, and cells are looked up by the million.
inline int floor_to_int(double value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < towards_zero ? 1 : 0);
}

/// One level of the pyramid. Cell (x, y) of a level with `stride_cells` = s holds the largest score among the
/// finest cells [x s, (x + 2) s) x [y s, (y + 2) s) for s > 1, and the score itself for s = 1. Twice the
/// stride, because a block of s shifts of a point that stands anywhere reaches into two aligned blocks: so
/// each level needs only 1 / s^2 of the finest one's memory and stays in the cache.
class ScoreLevel {
 public:
  /// Cells of zeros on every side; right of them another kRunPadding, for vector loads that run over.
  static constexpr int kMargin = 16;
  static constexpr int kRunPadding = 64;

  ScoreLevel() = default;
  ScoreLevel(int width, int height, int stride_cells);

  int width() const { return width_; }
  int height() const { return height_; }
  int stride_cells() const { return stride_cells_; }
  /// Bytes from a cell to the one above it.
  std::ptrdiff_t row_bytes() const { return row_bytes_; }

  /// The score of a cell, 0 .. 255; 0 outside.
  std::uint8_t at(int x, int y) const { return inside(x, y) ? *cell(x, y) : std::uint8_t{0}; }
  /// True where `cell` may be called: inside the grid or its margin.
  bool inside(int x, int y) const {
    return x >= -kMargin && x < width_ + kMargin && y >= -kMargin && y < height_ + kMargin;
  }
  const std::uint8_t* cell(int x, int y) const { return bytes_.data() + index(x, y); }
  std::uint8_t* cell(int x, int y) { return bytes_.data() + index(x, y); }
  std::size_t memory_bytes() const { return bytes_.size(); }

  /// All cells, margin and padding included; take_bytes() leaves none, until give_bytes() gives them back.
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

/// The finest grid and its pyramid, in the frame of its local map. Value 255 is probability 1.
class ScoreGrid {
 public:
  /// Strides of the levels above the finest, from fine to coarse.
  static constexpr std::array<int, 2> kStrides = {2, 8};

  ScoreGrid() = default;
  /// A grid of zeros whose cell (0, 0) covers [origin, origin + resolution) on both axes, in metres.
  ScoreGrid(double origin_x_m, double origin_y_m, double resolution_m, int width, int height);

  double origin_x_m() const { return origin_x_m_; }
  double origin_y_m() const { return origin_y_m_; }
  double resolution_m() const { return resolution_m_; }
  const ScoreLevel& finest() const { return finest_; }
  ScoreLevel& finest() { return finest_; }

  /// The cells [x, x + width) x [y, y + height) alone, without a pyramid. They must lie inside.
  ScoreGrid cropped(int x, int y, int width, int height) const;

  /// Builds the levels above the finest. To be called when the finest grid is final; a matcher that needs the
  /// pyramid refuses a grid without it.
  void build_pyramid();
  void drop_pyramid() { pyramid_.clear(); }
  bool has_pyramid() const { return !pyramid_.empty(); }
  /// Level i has stride kStrides[i].
  const ScoreLevel& pyramid(std::size_t i) const { return pyramid_[i]; }

  /// The score, in [0, 1], interpolated between cell centres by Catmull-Rom cubic splines, and its gradient
  /// per metre; zero outside.
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
};

}  // namespace psi_slam
