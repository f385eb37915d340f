// SPDX-License-Identifier: BSD-3-Clause
#include "matching/bound_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "matching/sum_kernel.h"
#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

// The largest sum of the block's poses inside the window.
std::uint32_t slow_best(const SearchLattice& lattice, const BoundLevel& level, int layer, int row,
                        int column) {
  const SearchWindow& window = lattice.window();
  const int stride = level.stride_cells();
  std::uint32_t best = 0;
  for (int turn = layer * level.headings(); turn < (layer + 1) * level.headings(); ++turn)
    for (int y = row * stride; y < (row + 1) * stride; ++y)
      for (int x = column * stride; x < (column + 1) * stride; ++x)
        if (turn <= 2 * window.n_theta && y <= 2 * window.n_y && x <= 2 * window.n_x)
          best = std::max(best, slow_sum(lattice, {x - window.n_x, y - window.n_y, turn - window.n_theta}));
  return best;
}

std::vector<std::uint32_t> all_bounds(BoundLevel& level, int layer) {
  const int row = level.columns() + kSumLanes;
  std::vector<std::uint32_t> bounds(static_cast<std::size_t>(row * level.rows()), 0);
  level.add_bounds(layer, {0, 0}, level.columns(), level.rows(), bounds.data(), row);
  std::vector<std::uint32_t> packed;
  for (int y = 0; y < level.rows(); ++y)
    packed.insert(packed.end(), bounds.begin() + y * row, bounds.begin() + y * row + level.columns());
  return packed;
}

// Windows inside the grid, over its edges and far from it; angular steps that move the farthest point by a
// part of a cell or by many cells.
TEST(BoundLevel, bounds_every_pose_of_every_block) {
  std::mt19937_64 random(101);
  std::uniform_int_distribution<int> side(1, 60);
  std::uniform_int_distribution<int> steps(1, 12);
  std::uniform_real_distribution<double> metres(-3, 4);
  std::int64_t tight = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const ScoreGrid grid = random_grid(random, side(random), side(random), trial % 2 == 0 ? 256 : 2);
    const ScanPoints scan = random_points(random, 1 + random() % 6, 2.0);
    const double turn_rad = trial % 3 == 0 ? 0.002 : trial % 3 == 1 ? 0.02 : 0.2;
    const SearchLattice lattice(grid, scan, {metres(random), metres(random), metres(random)},
                                window_of_steps(steps(random), steps(random), steps(random), turn_rad));
    for (const int stride : {4, 8, 16}) {
      BoundLevel level(lattice, stride);
      ASSERT_GE(level.layers() * level.headings(), 2 * lattice.window().n_theta + 1);
      for (int layer = 0; layer < level.layers(); ++layer) {
        const std::vector<std::uint32_t> bounds = all_bounds(level, layer);
        for (int row = 0; row < level.rows(); ++row)
          for (int column = 0; column < level.columns(); ++column) {
            const std::uint32_t bound = bounds[static_cast<std::size_t>(row * level.columns() + column)];
            const std::uint32_t best = slow_best(lattice, level, layer, row, column);
            ASSERT_GE(bound, best) << "trial " << trial << ", stride " << stride << ", layer " << layer
                                   << ", row " << row << ", column " << column;
            tight += bound == best ? 1 : 0;
          }
      }
    }
  }
  EXPECT_GT(tight, 1000);
}

// One bright cell, one point and one heading: only the blocks that contain the shift onto the cell, or touch
// it within the half cells, have its score as bound.
TEST(BoundLevel, is_as_tight_as_half_cells_allow) {
  ScanPoints scan;
  scan.points.emplace_back(0.0F, 0.0F);
  scan.farthest_m = 0.1;
  for (int at = 0; at < 16; ++at) {
    ScoreGrid grid(0, 0, 0.05, 64, 64);
    *grid.finest().cell(24 + at, 30) = 200;
    const SearchLattice lattice(grid, scan, {1.6, 1.6, 0}, window_of_steps(16, 16, 0, 0.01));
    BoundLevel level(lattice, 8);
    ASSERT_EQ(level.layers(), 1);
    const std::vector<std::uint32_t> bounds = all_bounds(level, 0);
    const std::int64_t reached = std::count(bounds.begin(), bounds.end(), 200U);
    EXPECT_GE(reached, 1);
    EXPECT_LE(reached, 4);
    EXPECT_EQ(bounds[static_cast<std::size_t>((30 - 16) / 8 * level.columns() + (24 + at - 16) / 8)], 200U);
  }
}

TEST(BoundLevel, spans_headings_that_move_the_farthest_point_by_a_stride_at_most) {
  std::mt19937_64 random(102);
  const ScoreGrid grid = random_grid(random, 30, 30, 4);
  ScanPoints scan;
  scan.points.emplace_back(5.0F, 0.0F);  // 100 cells
  scan.farthest_m = 5;
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(4, 4, 50, 0.01));
  EXPECT_EQ(BoundLevel(lattice, 4).headings(), 4) << "three steps of one cell";
  EXPECT_EQ(BoundLevel(lattice, 8).headings(), 8);
  EXPECT_EQ(BoundLevel(lattice, 8).layers(), 13) << "101 headings";
}

TEST(BoundLevel, adds_parts_of_rows) {
  std::mt19937_64 random(103);
  const ScoreGrid grid = random_grid(random, 90, 70, 256);
  const ScanPoints scan = random_points(random, 20, 1.5);
  const SearchLattice lattice(grid, scan, {0.5, 0.3, 0.2}, window_of_steps(40, 33, 6, 0.02));
  BoundLevel level(lattice, 4);
  const std::vector<std::uint32_t> all = all_bounds(level, 1);
  std::vector<std::uint32_t> part(2 * kSumLanes, 7);
  level.add_bounds(1, {5, 6}, 3, 2, part.data(), kSumLanes);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      EXPECT_EQ(part[static_cast<std::size_t>(y * kSumLanes + x)],
                7 + all[static_cast<std::size_t>((6 + y) * level.columns() + 5 + x)]);
}

}  // namespace
}  // namespace psi_slam
