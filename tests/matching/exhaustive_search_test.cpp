// SPDX-License-Identifier: BSD-3-Clause
#include "matching/exhaustive_search.h"

#include <gtest/gtest.h>

#include <random>

#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

TEST(ExhaustiveSearch, finds_what_three_loops_find_ties_included) {
  std::mt19937_64 random(31);
  std::uniform_int_distribution<int> steps(1, 9);
  std::uniform_real_distribution<double> metres(-2, 3);
  int ties = 0;
  for (int trial = 0; trial < 300; ++trial) {
    // Two levels and few points: the highest sum is reached in many places.
    const ScoreGrid grid = random_grid(random, 40, 30, trial % 3 == 0 ? 256 : 2);
    const ScanPoints scan = random_points(random, 1 + random() % 30, 1.0);
    const SearchLattice lattice(grid, scan, {metres(random), metres(random), metres(random)},
                                window_of_steps(steps(random), steps(random), steps(random), 0.05));
    const SearchOutcome outcome = exhaustive_search(lattice, 0);
    const std::optional<Candidate> expected = slow_search(lattice, 0);
    ASSERT_TRUE(same(outcome.best, expected)) << to_text(outcome.best) << ", not " << to_text(expected);

    const SearchWindow& window = lattice.window();
    EXPECT_EQ(outcome.evaluations, (2 * window.n_x + 1) * (2 * window.n_y + 1) * (2 * window.n_theta + 1));
    const LatticePose around_best = expected->pose;
    const std::optional<Candidate> another =
        slow_search(lattice, expected->sum, ExcludedRegion{around_best, 1, 1});
    if (another) ++ties;
  }
  EXPECT_GT(ties, 100) << "the trials shall try the tie-break";
}

TEST(ExhaustiveSearch, leaves_out_the_excluded_region) {
  std::mt19937_64 random(32);
  std::uniform_real_distribution<double> metres(-1, 1);
  for (int trial = 0; trial < 100; ++trial) {
    const ScoreGrid grid = random_grid(random, 40, 40, trial % 2 == 0 ? 256 : 3);
    const ScanPoints scan = random_points(random, 20, 1.0);
    const SearchLattice lattice(grid, scan, {metres(random), metres(random), 0},
                                window_of_steps(8, 7, 6, 0.05));
    const SearchOutcome best = exhaustive_search(lattice, 0);
    ASSERT_TRUE(best.best);
    const ExcludedRegion around = {best.best->pose, 1 + trial % 5, 1 + trial % 4};
    const SearchOutcome next = exhaustive_search(lattice, 0, around);
    ASSERT_TRUE(next.best);
    EXPECT_FALSE(around.contains(next.best->pose));
    const std::optional<Candidate> expected = slow_search(lattice, 0, around);
    ASSERT_TRUE(same(next.best, expected)) << to_text(next.best) << ", not " << to_text(expected);
  }
}

TEST(ExhaustiveSearch, finds_nothing_when_all_is_excluded) {
  std::mt19937_64 random(33);
  const ScoreGrid grid = random_grid(random, 20, 20, 256);
  const ScanPoints scan = random_points(random, 10, 0.5);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(3, 3, 3, 0.05));
  EXPECT_FALSE(exhaustive_search(lattice, 0, ExcludedRegion{{0, 0, 0}, 4, 4}).best);
  EXPECT_TRUE(exhaustive_search(lattice, 0, ExcludedRegion{{0, 0, 0}, 4, 3}).best);
}

TEST(ExhaustiveSearch, the_smallest_sum_is_reached_by_equality) {
  std::mt19937_64 random(34);
  const ScoreGrid grid = random_grid(random, 30, 30, 256);
  const ScanPoints scan = random_points(random, 15, 0.5);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(5, 5, 5, 0.05));
  const std::optional<Candidate> best = slow_search(lattice, 0);
  EXPECT_TRUE(same(exhaustive_search(lattice, best->sum).best, best));
  EXPECT_FALSE(exhaustive_search(lattice, best->sum + 1).best);
}

TEST(ExhaustiveSearch, far_from_the_grid_the_centre_is_the_best_of_equals) {
  std::mt19937_64 random(35);
  const ScoreGrid grid = random_grid(random, 30, 30, 256);
  const ScanPoints scan = random_points(random, 15, 0.5);
  const SearchLattice lattice(grid, scan, {500, -700, 0}, window_of_steps(5, 5, 5, 0.05));
  const SearchOutcome outcome = exhaustive_search(lattice, 0);
  EXPECT_TRUE(same(outcome.best, Candidate{0, {0, 0, 0}})) << to_text(outcome.best);
  EXPECT_FALSE(exhaustive_search(lattice, 1).best);
}

}  // namespace
}  // namespace psi_slam
