// SPDX-License-Identifier: BSD-3-Clause
#include "matching/bound_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "matching/exact_search.h"
#include "score_grids.h"

namespace psi_slam {
namespace {

bool equal(const BoundTables& a, const BoundTables& b) {
  return a.memory_bytes() == b.memory_bytes() &&
         std::equal(a.bytes(), a.bytes() + a.memory_bytes(), b.bytes());
}

// Scores change in rectangles, some of which touch the edges of the grid and of the tables.
TEST(BoundTables, updates_give_the_same_tables_as_the_whole_grid_at_once) {
  std::mt19937_64 random(111);
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<std::uint64_t>(end)); };
  for (int trial = 0; trial < 60; ++trial) {
    const int width = 20 + below(60);
    const int height = 20 + below(60);
    ScoreGrid grid(0, 0, 0.05, width, height);
    const Cell first = {below(8), below(8)};
    const Cell end = {width - below(8), height - below(8)};
    const int stride = 4 << trial % 3;
    BoundTables updated(stride, first, end, 5, 3);
    for (int change = 0; change < 5; ++change) {
      const Cell low = {below(width), below(height)};
      const Cell high = {low.x + 1 + below(width - low.x), low.y + 1 + below(height - low.y)};
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
          *grid.finest().cell(x, y) = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : 0);
      updated.update(grid.finest(), low, high);
      BoundTables fresh(stride, first, end, 5, 3);
      fresh.update(grid.finest(), first, end);
      ASSERT_TRUE(equal(updated, fresh)) << "trial " << trial << ", change " << change;
    }
  }
}

TEST(BoundTables, of_the_grid_find_the_same_pose_in_windows_of_all_sizes) {
  std::mt19937_64 random(112);
  for (const int steps : {1, 5, 20, 62, 63, 64, 80}) {
    for (int trial = 0; trial < 4; ++trial) {
      ScoreGrid grid = random_grid(random, 70 + trial, 61, trial % 2 == 0 ? 256 : 2);
      const ScanPoints scan = random_points(random, 12, 2.0);
      const SearchLattice lattice(grid, scan, {0.4, -0.2, 0.1 * trial},
                                  window_of_steps(steps, steps, 9, 0.02));
      const SearchOutcome expected = exhaustive_search(lattice, 0);
      grid.make_bounds();
      grid.update_bounds({0, 0}, {grid.finest().width(), grid.finest().height()});
      const SearchOutcome found = ExactSearch(lattice).find(0);
      ASSERT_TRUE(found.best.has_value());
      EXPECT_EQ(found.best->sum, expected.best->sum);
      EXPECT_EQ(found.best->pose.x, expected.best->pose.x);
      EXPECT_EQ(found.best->pose.y, expected.best->pose.y);
      EXPECT_EQ(found.best->pose.theta, expected.best->pose.theta);
      if (steps < 6) {
        EXPECT_EQ(found.search, SearchKind::kBranchAndBound) << "without tables, the search is exhaustive";
      }
    }
  }
}

}  // namespace
}  // namespace psi_slam
