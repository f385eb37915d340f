// SPDX-License-Identifier: BSD-3-Clause
#include "match/depth_first_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "../matching/score_grids.h"
#include "../matching/slow_search.h"
#include "matching/exact_search.h"

namespace psi_slam {
namespace {

TEST(MaximumGrids, hold_the_brute_force_maxima) {
  std::mt19937_64 random(121);
  const ScoreGrid grid = random_grid(random, 23, 17, 256);
  const MaximumGrids grids(grid);
  for (int level = 0; level < MaximumGrids::kLevels; ++level) {
    const int side = 1 << level;
    for (int y = -side - 2; y < 20; ++y) {
      for (int x = -side - 2; x < 26; ++x) {
        std::uint8_t largest = 0;
        for (int j = std::max(0, y); j < std::min(17, y + side); ++j)
          for (int i = std::max(0, x); i < std::min(23, x + side); ++i)
            largest = std::max(largest, grid.finest().at(i, j));
        ASSERT_EQ(grids.at(level, x, y), largest) << "level " << level << ", (" << x << ", " << y << ")";
      }
    }
  }
}

TEST(DepthFirstSearch, equals_the_exhaustive_search_including_ties) {
  std::mt19937_64 random(122);
  std::uniform_int_distribution<int> steps(1, 40);
  std::uniform_real_distribution<double> metres(-2, 3);
  for (int trial = 0; trial < 60; ++trial) {
    const ScoreGrid grid = random_grid(random, 50, 40, trial % 2 == 0 ? 2 : 256);
    const ScanPoints scan = random_points(random, 1 + random() % 20, 1.5);
    const SearchLattice lattice(grid, scan, {metres(random), metres(random), metres(random)},
                                window_of_steps(steps(random), steps(random), steps(random) / 8, 0.03));
    const MaximumGrids grids(grid);
    const std::optional<Candidate> best = exhaustive_search(lattice, 0).best;
    for (const std::uint32_t least : {std::uint32_t{0}, best->sum, best->sum + 1}) {
      const std::optional<Candidate> found = depth_first_search(lattice, grids, least).best;
      const std::optional<Candidate> expected = least <= best->sum ? best : std::nullopt;
      ASSERT_TRUE(same(found, expected)) << to_text(found) << ", not " << to_text(expected);
    }
  }
}

TEST(DepthFirstSearch, counts_its_nodes) {
  std::mt19937_64 random(123);
  const ScoreGrid grid = random_grid(random, 30, 30, 256);
  const ScanPoints scan = random_points(random, 10, 1.0);
  const SearchLattice lattice(grid, scan, {0.5, 0.5, 0}, window_of_steps(64, 31, 2, 0.05));
  const MaximumGrids grids(grid);
  EXPECT_EQ(depth_first_search(lattice, grids, lattice.goal_max() + 1).evaluations, 3 * 1 * 5)
      << "only the roots: 129 x 63 shifts in squares of 64 x 64, at 5 headings";
}

}  // namespace
}  // namespace psi_slam
