// SPDX-License-Identifier: BSD-3-Clause
#include "matching/tile_scorer.h"

#include <gtest/gtest.h>

#include <random>

#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

struct Problem {
  std::mt19937_64 random{81};
  ScoreGrid grid = random_grid(random, 90, 70, 16);
  ScanPoints scan = random_points(random, 25, 1.5);
  SearchLattice lattice{grid, scan, {0.3, 0.2, 0.1}, window_of_steps(20, 19, 3, 0.03)};
};

Candidate slow_best(const SearchLattice& lattice, const Tile& tile) {
  std::optional<Candidate> best;
  for (int y = tile.block.first.y; y < tile.block.first.y + tile.block.height; ++y)
    for (int x = tile.block.first.x; x < tile.block.first.x + tile.block.width; ++x) {
      const Candidate candidate = {slow_sum(lattice, {x, y, tile.theta}), {x, y, tile.theta}};
      if (!best || candidate.better_than(*best)) best = candidate;
    }
  return *best;
}

TEST(TileScorer, finds_the_best_pose_of_a_tile_and_bounds_it_on_the_pooled_level) {
  const Problem problem;
  TileScorer scorer(problem.lattice);
  const WindowTiles space(problem.lattice.window(), true);
  for (int theta = -3; theta <= 3; ++theta)
    for (int row = 0; row < space.rows(); ++row)
      for (int column = 0; column < space.columns(); ++column) {
        const Tile tile = space.tile(space.encode(theta, column, row));
        const Candidate best = scorer.score(tile, TileLevel::kFinest);
        const Candidate expected = slow_best(problem.lattice, tile);
        ASSERT_TRUE(same(best, expected)) << to_text(best) << ", not " << to_text(expected);
        EXPECT_GE(scorer.score(tile, TileLevel::kPooled).sum, best.sum);
      }
}

TEST(TileScorer, finds_the_best_pose_near_one_within_the_window) {
  const Problem problem;
  TileScorer scorer(problem.lattice);
  for (const LatticePose& pose : {LatticePose{0, 0, 0}, {-20, 19, 3}, {20, -3, -3}, {-15, 12, 1}}) {
    const int x = std::max(-20, pose.x - 8);
    const int y = std::max(-19, pose.y - 8);
    const Candidate expected =
        slow_best(problem.lattice,
                  Tile{pose.theta, {{x, y}, std::min(21, pose.x + 8) - x, std::min(20, pose.y + 8) - y}});
    const Candidate best = scorer.best_near(pose);
    EXPECT_TRUE(same(best, expected)) << to_text(best) << ", not " << to_text(expected);
  }
}

TEST(TileScorer, counts_the_poses_it_scores) {
  const Problem problem;
  TileScorer scorer(problem.lattice);
  scorer.score({0, {{0, 0}, 7, 5}}, TileLevel::kFinest);
  EXPECT_EQ(scorer.evaluations(), 35);
  scorer.score({0, {{0, 0}, 7, 5}}, TileLevel::kPooled);
  EXPECT_EQ(scorer.evaluations(), 35 + 4 * 3);
}

}  // namespace
}  // namespace psi_slam
