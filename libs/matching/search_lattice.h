// SPDX-License-Identifier: BSD-3-Clause
// Poses of a search window as integers: shifts by cells and turns by angular steps around the predicted pose.
// The scan is rotated once per angle, then only shifted (the look-up table of the paper).
#pragma once

#include <mrpt/math/TPose2D.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "matching/scan_points.h"
#include "matching/score_grid.h"
#include "matching/search_window.h"

namespace psi_slam {

struct Cell {
  std::int32_t x;
  std::int32_t y;
};

/// A pose of the lattice, in steps from the window's centre: |x| <= n_x, |y| <= n_y, |theta| <= n_theta.
struct LatticePose {
  int x = 0;
  int y = 0;
  int theta = 0;
};

/// A scored pose. Candidates have a total order, so that every search finds the same one: the higher sum,
/// then the pose nearer to the window's centre, then the lower (theta, y, x).
struct Candidate {
  std::uint32_t sum = 0;  ///< sum of the scores under the points, each 0 .. 255
  LatticePose pose;

  bool better_than(const Candidate& other) const;
};

/// Poses that a search skips: those less than `cells` from `centre` along both axes and less than `turns` in
/// angle.
struct ExcludedRegion {
  LatticePose centre;
  int cells = 0;
  int turns = 0;

  bool contains(const LatticePose& pose) const;
};

/// A block of shifts, [first, first + width) x [first, first + height).
struct ShiftBlock {
  Cell first = {0, 0};
  int width = 0;
  int height = 0;
};

/// Returns the part of a block outside the region at a heading: the whole block, or the strips below, above,
/// left and right of the excluded square. Strips can be empty.
std::array<ShiftBlock, 4> outside(const ExcludedRegion& excluded, int theta, const ShiftBlock& block);

class SearchLattice {
 public:
  /// Keeps references to the grid and the scan.
  SearchLattice(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot,
                const SearchWindow& window);

  SearchLattice(const ScoreGrid& grid, ScanPoints&& scan, const mrpt::math::TPose2D& map_T_robot,
                const SearchWindow& window) = delete;

  const ScoreGrid& grid() const { return *grid_; }
  const ScanPoints& scan() const { return *scan_; }
  const SearchWindow& window() const { return window_; }
  std::size_t points() const { return points_; }
  /// The largest possible sum: every point on a cell of probability 1.
  std::uint32_t goal_max() const { return static_cast<std::uint32_t>(255 * points_); }

  /// Finest cells of all points, turned by `theta` steps and not shifted. Computed at the first call for each
  /// `theta`, so a lattice is not thread-safe.
  const Cell* cells(int theta) const {
    const auto turn = static_cast<std::size_t>(theta + window_.n_theta);
    if (!turned_[turn]) turn_scan(theta);
    return cells_.get() + turn * points_;
  }
  mrpt::math::TPose2D pose(const LatticePose& steps) const;
  /// Response R_v of equation 11.
  double response(std::uint32_t sum) const { return static_cast<double>(sum) / goal_max(); }

 private:
  void turn_scan(int theta) const;

  const ScoreGrid* grid_;
  const ScanPoints* scan_;
  SearchWindow window_;
  mrpt::math::TPose2D centre_;
  std::size_t points_;
  mutable std::unique_ptr<Cell[]> cells_;  // uninitialised until turned
  mutable std::vector<bool> turned_;
};

/// Sums of scores for a block of neighbouring shifts. A search reuses the memory from block to block.
class ShiftSums {
 public:
  /// Computes, for x < width and y < height, the sum over all cells of the level's score at cell + shift +
  /// (x, y) strides. `shift` is in finest cells.
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
