// SPDX-License-Identifier: BSD-3-Clause
#include "matching/exact_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "real_scans.h"
#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

TEST(ExhaustiveSearch, equals_three_plain_loops_including_ties) {
  std::mt19937_64 random(31);
  std::uniform_int_distribution<int> steps(1, 9);
  std::uniform_real_distribution<double> metres(-2, 3);
  int ties = 0;
  for (int trial = 0; trial < 300; ++trial) {
    // With two score values and few points, many poses reach the highest sum.
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
  EXPECT_GT(ties, 100) << "the trials must test the tie-break";
}

TEST(ExhaustiveSearch, skips_the_excluded_region) {
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

TEST(ExhaustiveSearch, accepts_a_sum_equal_to_the_smallest) {
  std::mt19937_64 random(34);
  const ScoreGrid grid = random_grid(random, 30, 30, 256);
  const ScanPoints scan = random_points(random, 15, 0.5);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(5, 5, 5, 0.05));
  const std::optional<Candidate> best = slow_search(lattice, 0);
  EXPECT_TRUE(same(exhaustive_search(lattice, best->sum).best, best));
  EXPECT_FALSE(exhaustive_search(lattice, best->sum + 1).best);
}

TEST(ExhaustiveSearch, far_from_the_grid_the_centre_wins_the_tie) {
  std::mt19937_64 random(35);
  const ScoreGrid grid = random_grid(random, 30, 30, 256);
  const ScanPoints scan = random_points(random, 15, 0.5);
  const SearchLattice lattice(grid, scan, {500, -700, 0}, window_of_steps(5, 5, 5, 0.05));
  const SearchOutcome outcome = exhaustive_search(lattice, 0);
  EXPECT_TRUE(same(outcome.best, Candidate{0, {0, 0, 0}})) << to_text(outcome.best);
  EXPECT_FALSE(exhaustive_search(lattice, 1).best);
}

using mrpt::math::TPose2D;

// Compares both searches with the `min_sum` 0, the best sum, and the best sum plus one. Also compares them
// with an excluded region around the best pose.
void expect_equal_outcomes(const SearchLattice& lattice, const std::string& where) {
  const SearchOutcome exhaustive = exhaustive_search(lattice, 0);
  const SearchOutcome fast = branch_and_bound_search(lattice, 0);
  ASSERT_TRUE(same(fast.best, exhaustive.best))
      << where << ": " << to_text(fast.best) << ", not " << to_text(exhaustive.best);
  const Candidate best = *exhaustive.best;
  const SearchOutcome reached = branch_and_bound_search(lattice, best.sum);
  ASSERT_TRUE(same(reached.best, best)) << where << ": " << to_text(reached.best);
  ASSERT_FALSE(branch_and_bound_search(lattice, best.sum + 1).best) << where;

  const ExcludedRegion around = {best.pose, 1 + lattice.window().n_x / 4, 1 + lattice.window().n_theta / 4};
  const SearchOutcome next = exhaustive_search(lattice, best.sum / 2, around);
  const SearchOutcome fast_next = branch_and_bound_search(lattice, best.sum / 2, around);
  ASSERT_TRUE(same(fast_next.best, next.best))
      << where << ", next: " << to_text(fast_next.best) << ", not " << to_text(next.best);
}

TEST(BranchAndBound, does_not_score_the_block_of_a_descent_again) {
  std::mt19937_64 random(40);
  const ScoreGrid grid = random_grid(random, 30, 30, 256);
  const ScanPoints scan = random_points(random, 15, 0.5);
  // Far from the grid, all sums are 0, so no block can be left out.
  const SearchLattice lattice(grid, scan, {500, -700, 0}, window_of_steps(3, 3, 20, 0.05));
  constexpr int kPoses = 7 * 7;
  constexpr int kBlocks = 1 + 4 + 4;  // one of 8 x 8, its four quarters, and these again on the first descent
  EXPECT_GE(branch_and_bound_search(lattice, 0).evaluations, 41 * kPoses);
  EXPECT_LE(branch_and_bound_search(lattice, 0).evaluations, 41 * (kPoses + kBlocks));
}

TEST(BranchAndBound, equals_the_exhaustive_search_on_random_grids) {
  std::mt19937_64 random(41);
  std::uniform_int_distribution<int> steps(1, 30);
  std::uniform_int_distribution<int> side(5, 120);
  std::uniform_real_distribution<double> metres(-3, 4);
  for (int trial = 0; trial < 300; ++trial) {
    const int levels = trial % 3 == 0 ? 2 : trial % 3 == 1 ? 5 : 256;
    const ScoreGrid grid = random_grid(random, side(random), side(random), levels);
    const ScanPoints scan = random_points(random, 1 + random() % 40, 2.0);
    const SearchLattice lattice(grid, scan, {metres(random), metres(random), metres(random)},
                                window_of_steps(steps(random), steps(random), steps(random) / 3 + 1, 0.03));
    ASSERT_NO_FATAL_FAILURE(expect_equal_outcomes(lattice, "trial " + std::to_string(trial)));
  }
}

// With few points and few walls, many poses have equal sums.
TEST(BranchAndBound, equals_the_exhaustive_search_with_many_ties) {
  std::mt19937_64 random(42);
  std::uniform_int_distribution<int> cell(0, 79);
  std::uniform_int_distribution<int> steps(3, 24);
  for (int trial = 0; trial < 200; ++trial) {
    ScoreGrid grid(0, 0, 0.05, 80, 80);
    const int row = cell(random);
    const int column = cell(random);
    for (int i = 0; i < 80; ++i) {
      *grid.finest().cell(i, row) = 255;
      if (trial % 2 == 0) *grid.finest().cell(column, i) = 255;
    }
    grid.build_pyramid();
    const ScanPoints scan = random_points(random, 1 + random() % 4, 1.0);
    const SearchLattice lattice(grid, scan, {2, 2, 0.1 * trial},
                                window_of_steps(steps(random), steps(random), steps(random) / 3, 0.05));
    ASSERT_NO_FATAL_FAILURE(expect_equal_outcomes(lattice, "trial " + std::to_string(trial)));
  }
}

TEST(BranchAndBound, equals_three_plain_loops) {
  std::mt19937_64 random(43);
  for (int trial = 0; trial < 50; ++trial) {
    const ScoreGrid grid = random_grid(random, 50, 50, 3);
    const ScanPoints scan = random_points(random, 12, 1.0);
    const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(9, 8, 4, 0.05));
    const SearchOutcome outcome = branch_and_bound_search(lattice, 0);
    const std::optional<Candidate> expected = slow_search(lattice, 0);
    ASSERT_TRUE(same(outcome.best, expected)) << to_text(outcome.best) << ", not " << to_text(expected);
  }
}

TEST(BranchAndBound, finds_nothing_when_all_is_excluded) {
  std::mt19937_64 random(44);
  const ScoreGrid grid = random_grid(random, 50, 50, 256);
  const ScanPoints scan = random_points(random, 12, 1.0);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(9, 8, 4, 0.05));
  EXPECT_FALSE(branch_and_bound_search(lattice, 0, ExcludedRegion{{0, 0, 0}, 10, 5}).best);
}

TEST(BranchAndBound, needs_no_pyramid) {
  std::mt19937_64 random(45);
  ScoreGrid grid = random_grid(random, 50, 50, 256);
  grid.drop_pyramid();
  const ScanPoints scan = random_points(random, 12, 1.0);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(20, 18, 4, 0.05));
  ASSERT_NO_FATAL_FAILURE(expect_equal_outcomes(lattice, "without pyramid"));
}

// Random thresholds and excluded regions, also such as contain or cut the best poses.
TEST(BranchAndBound, equals_the_exhaustive_search_at_any_threshold_and_around_any_region) {
  std::mt19937_64 random(47);
  std::uniform_int_distribution<int> steps(1, 25);
  std::uniform_int_distribution<int> extent(1, 12);
  std::uniform_real_distribution<double> metres(-2, 3);
  std::uniform_real_distribution<double> share(0, 1.1);
  int found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const ScoreGrid grid = random_grid(random, 60, 50, trial % 2 == 0 ? 2 : 256);
    const ScanPoints scan = random_points(random, 1 + random() % 20, 1.5);
    const int turns = steps(random) / 2 + 1;
    const SearchLattice lattice(grid, scan, {metres(random), metres(random), metres(random)},
                                window_of_steps(steps(random), steps(random), turns, 0.02));
    const SearchWindow& window = lattice.window();
    const auto shift = [&random](int n) { return std::uniform_int_distribution<int>(-n, n)(random); };
    const ExcludedRegion region = {
        {shift(window.n_x), shift(window.n_y), shift(window.n_theta)}, extent(random), extent(random)};
    const auto least =
        static_cast<std::uint32_t>(share(random) * exhaustive_search(lattice, 0).best.value().sum);
    const SearchOutcome expected = exhaustive_search(lattice, least, region);
    const SearchOutcome outcome = branch_and_bound_search(lattice, least, region);
    ASSERT_TRUE(same(outcome.best, expected.best))
        << "trial " << trial << ": " << to_text(outcome.best) << ", not " << to_text(expected.best);
    found += outcome.best ? 1 : 0;
  }
  EXPECT_GT(found, 100);
  EXPECT_LT(found, 290);
}

// Windows with more than 150 million poses have one more level of blocks.
TEST(BranchAndBound, equals_the_exhaustive_search_in_a_huge_window) {
  std::mt19937_64 random(49);
  ScoreGrid grid(-10, -10, 0.05, 400, 400);
  for (int i = 0; i < 3000; ++i)
    *grid.finest().cell(static_cast<int>(random() % 400), static_cast<int>(random() % 400)) =
        static_cast<std::uint8_t>(1 + random() % 255);
  const ScanPoints scan = random_points(random, 5, 4.0);
  const SearchLattice lattice(grid, scan, {1, 2, 0.5}, window_of_steps(301, 302, 207, 0.015));
  const SearchOutcome exhaustive = exhaustive_search(lattice, 0);
  const SearchOutcome fast = branch_and_bound_search(lattice, 0);
  EXPECT_TRUE(same(fast.best, exhaustive.best)) << to_text(fast.best) << ", not " << to_text(exhaustive.best);
  EXPECT_GT(exhaustive.evaluations, 150'000'000);
  EXPECT_LT(fast.evaluations, exhaustive.evaluations / 10);
}

// Large windows are searched by branch and bound, small ones exhaustively.
TEST(ExactSearch, later_searches_of_a_window_do_not_depend_on_the_first) {
  std::mt19937_64 random(48);
  for (const int n : {6, 30}) {
    for (int trial = 0; trial < 5; ++trial) {
      const ScoreGrid grid = random_grid(random, 80, 80, 256);
      const ScanPoints scan = random_points(random, 15, 1.5);
      const SearchLattice lattice(grid, scan, {0.2, 0.1, 0.3}, window_of_steps(n, n, 10, 0.02));
      const Candidate best = exhaustive_search(lattice, 0).best.value();
      ExactSearch search(lattice);
      EXPECT_FALSE(search.find(best.sum + 1).best);
      EXPECT_TRUE(same(search.find(0).best, best));
      PeakRequest request;
      request.next = {3, 2, 0.5};
      FoundPeaks peaks;
      search.find_next(request, peaks);
      EXPECT_FALSE(peaks.next) << "no best peak, no next one";
      peaks.best = best;
      search.find_next(request, peaks);
      const auto least = static_cast<std::uint32_t>(std::ceil(0.5 * best.sum));
      const auto expected = exhaustive_search(lattice, least, ExcludedRegion{best.pose, 3, 2}).best;
      EXPECT_TRUE(same(peaks.next, expected)) << to_text(peaks.next) << ", not " << to_text(expected);
    }
  }
}

TEST(BranchAndBound, equals_the_exhaustive_search_on_real_scans) {
  const auto log = real_log();
  if (!log) GTEST_SKIP() << kNeedsRealScans;
  const RealScans real = read_real_scans(*log);
  ASSERT_FALSE(real.maps.empty());

  constexpr struct {
    SearchExtent extent;
    int cases;
  } kWindows[] = {{{0.3, 0.3, 0.1}, 16}, {{1.0, 0.7, 0.3}, 16},     {{2.0, 2.0, 0.35}, 12},
                  {{4.0, 4.0, 0.4}, 8},  {{8.0, 8.0, M_PI / 6}, 4}, {{7.9, 2.3, 0.05}, 4}};
  std::mt19937_64 random(46);
  std::uniform_real_distribution<double> share(-0.9, 0.9);
  for (const auto& window : kWindows) {
    std::int64_t exhaustive_poses = 0;
    std::int64_t fast_poses = 0;
    for (int trial = 0; trial < window.cases; ++trial) {
      const PlacedLocalMap& placed = real.maps[random() % real.maps.size()];
      // Two of three trials use a node of the local map with a wrong prediction. The third uses any node,
      // which need not match.
      const std::size_t within = placed.first_node + random() % (placed.last_node - placed.first_node + 1);
      const std::size_t node = trial % 3 < 2 ? within : random() % real.nodes.size();
      ScanPoints scan = *real.nodes[node].points;
      // In large windows, uses fewer points, because the slow search takes long.
      if (window.extent.x_m > 5 && window.extent.theta_rad > 0.1) {
        ScanPoints thinned;
        for (std::size_t p = 0; p < scan.points.size(); p += 3) thinned.points.push_back(scan.points[p]);
        thinned.farthest_m = std::min(scan.farthest_m, 15.0);
        scan = thinned;
      }
      TPose2D predicted = real.nodes[node].local_T_robot - placed.local_T_map;
      predicted.x += share(random) * window.extent.x_m;
      predicted.y += share(random) * window.extent.y_m;
      predicted.phi += share(random) * window.extent.theta_rad;
      const ScoreGrid& grid = static_cast<const LocalMap&>(*placed.map).scores();
      const SearchLattice lattice(grid, scan, predicted,
                                  make_search_window(window.extent, grid.resolution_m(), scan.farthest_m));
      ASSERT_NO_FATAL_FAILURE(expect_equal_outcomes(
          lattice, "node " + std::to_string(node) + " in local map " + std::to_string(placed.id) +
                       ", window of " + std::to_string(window.extent.x_m) + " m"));
      exhaustive_poses += exhaustive_search(lattice, 0).evaluations;
      fast_poses += branch_and_bound_search(lattice, 0).evaluations;
    }
    EXPECT_LT(fast_poses, exhaustive_poses / 2) << "window of " << window.extent.x_m << " m";
  }
}

}  // namespace
}  // namespace psi_slam
