// SPDX-License-Identifier: BSD-3-Clause
#include "matching/genetic_search.h"

#include <gtest/gtest.h>

#include <random>

#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

struct Room {
  SimulatedWalls walls = furnished_room();
  ScoreGrid grid = grid_of(walls);
  std::mt19937_64 random{101};
  mrpt::math::TPose2D truth{4, 3, 0.5};
  ScanPoints scan = scan_of(walls, truth, 90, 0.01, random);
  SearchLattice lattice{
      grid, scan, {4.3, 2.8, 0.45}, make_search_window({0.5, 0.5, 0.2}, 0.05, scan.farthest_m)};
};

PeakRequest request_of(std::uint64_t seed, std::uint32_t min_sum = 0) {
  PeakRequest request;
  request.min_sum = min_sum;
  request.seed = {seed, 2, 3};
  return request;
}

TEST(PaperGeneticSearch, scores_each_individual_of_each_generation_once) {
  const Room room;
  PaperGeneticOptions options;
  options.population = 31;
  options.generations = 7;
  const FoundPeaks peaks = paper_genetic_search(room.lattice, request_of(1), options);
  EXPECT_EQ(peaks.evaluations, 31 * 7);
  EXPECT_EQ(peaks.generations, 7);
}

TEST(PaperGeneticSearch, its_best_pose_has_the_returned_sum_and_does_not_exceed_the_best) {
  const Room room;
  const std::optional<Candidate> best = slow_search(room.lattice, 0);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const FoundPeaks peaks = paper_genetic_search(room.lattice, request_of(seed), {});
    ASSERT_TRUE(peaks.best);
    EXPECT_EQ(peaks.best->sum, slow_sum(room.lattice, peaks.best->pose));
    EXPECT_LE(peaks.best->sum, best->sum);
    EXPECT_LT(std::abs(peaks.best->pose.x), 11);
  }
}

// With selection, the search finds better poses than an equal number of random draws.
TEST(PaperGeneticSearch, does_better_than_chance) {
  const Room room;
  PaperGeneticOptions options;
  options.population = 60;
  options.generations = 15;
  PaperGeneticOptions chance = options;
  chance.mutation_rate = 0.5;  // every child is a random draw
  std::uint64_t evolved = 0;
  std::uint64_t drawn = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    evolved += paper_genetic_search(room.lattice, request_of(seed), options).best->sum;
    drawn += paper_genetic_search(room.lattice, request_of(seed), chance).best->sum;
  }
  EXPECT_GT(static_cast<double>(evolved), 1.05 * static_cast<double>(drawn));
}

TEST(PaperGeneticSearch, finds_the_robot_in_a_small_window) {
  const Room room;
  const std::optional<Candidate> best = slow_search(room.lattice, 0);
  int found = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Candidate candidate = *paper_genetic_search(room.lattice, request_of(seed), {}).best;
    if (candidate.sum > 0.95 * best->sum) ++found;
  }
  EXPECT_GE(found, 8);
}

TEST(PaperGeneticSearch, equal_seeds_give_equal_results_and_others_do_not) {
  const Room room;
  PaperGeneticOptions options;
  options.population = 20;
  options.generations = 3;
  const FoundPeaks a = paper_genetic_search(room.lattice, request_of(1), options);
  const FoundPeaks b = paper_genetic_search(room.lattice, request_of(1), options);
  EXPECT_TRUE(same(a.best, b.best));
  int others = 0;
  for (std::uint64_t seed = 2; seed < 6; ++seed)
    if (!same(paper_genetic_search(room.lattice, request_of(seed), options).best, a.best)) ++others;
  EXPECT_GT(others, 0);
}

TEST(PaperGeneticSearch, finds_nothing_below_the_smallest_sum) {
  const Room room;
  EXPECT_FALSE(paper_genetic_search(room.lattice, request_of(1, room.lattice.goal_max()), {}).best);
}

}  // namespace
}  // namespace psi_slam
