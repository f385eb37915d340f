// SPDX-License-Identifier: BSD-3-Clause
// The lattice: poses of a search window as integers, which count cells and angular steps from the predicted
// pose. The scan is rotated once per angle and then only shifted (the look-up table of the paper).
#pragma once

#include <mrpt/math/TPose2D.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "matching/cell.h"
#include "matching/scan_points.h"
#include "matching/score_grid.h"
#include "matching/search_window.h"

namespace psi_slam {

/// A pose of the lattice, in steps from the window's centre: |x| <= n_x, |y| <= n_y, |theta| <= n_theta.
struct LatticePose {
  int x = 0;
  int y = 0;
  int theta = 0;
};

/// A scored pose. A total order makes every search find the same best candidate. The higher sum is better,
/// then the pose nearer to the window's centre in steps, then the lower (theta, y, x).
struct Candidate {
  std::uint32_t sum = 0;  ///< sum of the scores under the points, each 0 .. 255
  LatticePose pose;

  bool better_than(const Candidate& other) const;
};

/// Poses that a search skips: they differ from `centre` by less than `cells` along x and y, and by less than
/// `turns` steps in angle.
struct ExcludedRegion {
  LatticePose centre;
  int cells = 0;
  int turns = 0;

  bool contains(const LatticePose& pose) const;
};

/// A block of shifts in cells: x in [first.x, first.x + width), y in [first.y, first.y + height).
struct ShiftBlock {
  Cell first = {0, 0};
  int width = 0;
  int height = 0;
};

/// Returns the part of a block outside the region, at the heading `theta`. This is the whole block, or the
/// strips below, above, left and right of the excluded square. Strips can be empty.
std::array<ShiftBlock, 4> outside(const ExcludedRegion& excluded, int theta, const ShiftBlock& block);

/// The lattice of a search window, with the scan turned by each of its headings.
class SearchLattice {
 public:
  /// Keeps references to the grid and the scan. `map_T_robot` is the centre of the window.
  SearchLattice(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot,
                const SearchWindow& window);

  SearchLattice(const ScoreGrid& grid, ScanPoints&& scan, const mrpt::math::TPose2D& map_T_robot,
                const SearchWindow& window) = delete;

  const ScoreGrid& grid() const { return *grid_; }
  const ScanPoints& scan() const { return *scan_; }
  const SearchWindow& window() const { return window_; }
  std::size_t points() const { return points_; }
  /// Largest possible sum: every point on a cell with score 255.
  std::uint32_t goal_max() const { return static_cast<std::uint32_t>(255 * points_); }

  /// Returns the finest cells of all points, turned by `theta` steps and not shifted. The first call for each
  /// `theta` computes them, so a lattice is not thread-safe.
  const Cell* cells(int theta) const {
    const auto turn = static_cast<std::size_t>(theta + window_.n_theta);
    if (!turned_[turn]) turn_scan(theta);
    return cells_.get() + turn * points_;
  }
  /// Returns a pose of the lattice in the map frame, with its heading in (-pi, pi].
  mrpt::math::TPose2D pose(const LatticePose& steps) const;
  /// Returns the response R_v of equation 11 for a sum of scores.
  double response(std::uint32_t sum) const { return static_cast<double>(sum) / goal_max(); }

 private:
  void turn_scan(int theta) const;

  const ScoreGrid* grid_;
  const ScanPoints* scan_;
  SearchWindow window_;
  mrpt::math::TPose2D centre_;
  std::size_t points_;
  // Cells by heading and point. The cells of a heading are uninitialised before turn_scan().
  mutable std::unique_ptr<Cell[]> cells_;
  mutable std::vector<bool> turned_;
};

/// Sums of scores for a block of neighbouring shifts. Repeated calls of compute() reuse the memory.
class ShiftSums {
 public:
  /// Computes one sum for each x < width and y < height: the sum over all `cells` of the level's score at
  /// cell + shift + (x, y) strides. `cells` and `shift` are in finest cells.
  void compute(const ScoreLevel& level, const Cell* cells, std::size_t points, Cell shift, int width,
               int height);

  const std::uint32_t* row(int y) const { return sums_.data() + y * row_; }

 private:
  void add_clipped(const ScoreLevel& level, Cell cell, int width, int height);

  std::vector<std::int32_t> offsets_;
  std::vector<std::uint32_t> sums_;
  std::ptrdiff_t row_ = 0;
};

}  // namespace psi_slam
