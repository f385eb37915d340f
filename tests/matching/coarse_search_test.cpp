// SPDX-License-Identifier: BSD-3-Clause
#include "matching/coarse_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

// Computes the sum of a coarse cell by its definition: adds the scores of the coarsest level at all points.
std::uint32_t slow_block_sum(const SearchLattice& lattice, const Tile& cell) {
  const ScoreLevel& level = lattice.grid().pyramid(1);
  std::uint32_t sum = 0;
  for (std::size_t p = 0; p < lattice.points(); ++p) {
    const Cell at = lattice.cells(cell.theta)[p];
    const auto divide = [&](int a) { return static_cast<int>(std::floor(a / 8.0)); };
    const int x = divide(at.x + cell.block.first.x);
    const int y = divide(at.y + cell.block.first.y);
    if (level.inside(x, y)) sum += *level.cell(x, y);
  }
  return sum;
}

struct Problem {
  std::mt19937_64 random{91};
  ScoreGrid grid = random_grid(random, 120, 90, 8);
  ScanPoints scan = random_points(random, 20, 1.0);
  SearchLattice lattice{grid, scan, {1, 1, 0.4}, window_of_steps(21, 18, 7, 0.03)};
};

TEST(CoarseCells, cover_the_window_in_the_order_of_their_sums) {
  const Problem problem;
  const CoarseCells coarse = rank_coarse_cells(problem.lattice, 1'000'000, 0);
  ASSERT_EQ(coarse.best.size(), 6U * 5U * 4U)
      << "43 x 37 shifts in blocks of 8 x 8, and 15 headings in groups of 4";
  EXPECT_EQ(coarse.evaluations, 120);
  for (std::size_t i = 1; i < coarse.best.size(); ++i)
    EXPECT_GE(slow_block_sum(problem.lattice, coarse.best[i - 1]),
              slow_block_sum(problem.lattice, coarse.best[i]));
  // The cells cover the window: at each of the four headings, every shift is in exactly one block.
  std::set<std::tuple<int, int, int>> shifts;
  std::set<int> headings;
  for (const Tile& cell : coarse.best) {
    headings.insert(cell.theta);
    for (int y = 0; y < cell.block.height; ++y)
      for (int x = 0; x < cell.block.width; ++x)
        EXPECT_TRUE(shifts.emplace(cell.theta, cell.block.first.x + x, cell.block.first.y + y).second);
  }
  EXPECT_EQ(headings, (std::set<int>{-5, -1, 3, 7}));
  EXPECT_EQ(shifts.size(), 43U * 37U * 4U);
}

TEST(CoarseCells, the_kept_cells_are_the_best_of_all) {
  const Problem problem;
  const CoarseCells all = rank_coarse_cells(problem.lattice, 1'000'000, 0);
  const CoarseCells few = rank_coarse_cells(problem.lattice, 9, 0);
  ASSERT_EQ(few.best.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(few.best[i].theta, all.best[i].theta);
    EXPECT_EQ(few.best[i].block.first.x, all.best[i].block.first.x);
    EXPECT_EQ(few.best[i].block.first.y, all.best[i].block.first.y);
  }
}

TEST(CoarseCells, cells_below_the_smallest_sum_are_dropped) {
  const Problem problem;
  const CoarseCells all = rank_coarse_cells(problem.lattice, 1'000'000, 0);
  const std::uint32_t middle = slow_block_sum(problem.lattice, all.best[all.best.size() / 2]);
  const CoarseCells upper = rank_coarse_cells(problem.lattice, 1'000'000, middle);
  const auto reach = std::count_if(all.best.begin(), all.best.end(), [&](const Tile& cell) {
    return slow_block_sum(problem.lattice, cell) >= middle;
  });
  EXPECT_EQ(static_cast<std::ptrdiff_t>(upper.best.size()), reach);
}

// The sum of a cell is an upper bound of the sums of its poses at its middle heading.
TEST(CoarseCells, sums_bound_the_poses_of_their_cells) {
  const Problem problem;
  for (const Tile& cell : rank_coarse_cells(problem.lattice, 20, 0).best)
    for (int y = 0; y < cell.block.height; y += 3)
      for (int x = 0; x < cell.block.width; x += 3)
        EXPECT_LE(slow_sum(problem.lattice, {cell.block.first.x + x, cell.block.first.y + y, cell.theta}),
                  slow_block_sum(problem.lattice, cell));
}

TEST(CoarseCells, need_the_pyramid) {
  std::mt19937_64 random(92);
  const ScoreGrid grid(0, 0, 0.05, 10, 10);
  const ScanPoints scan = random_points(random, 3, 1.0);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(1, 1, 1, 0.05));
  EXPECT_THROW(rank_coarse_cells(lattice, 10, 0), std::invalid_argument);
}

TEST(CoarseSeeds, of_one_block_are_evenly_spaced_headings) {
  std::mt19937_64 random(95);
  const ScoreGrid grid = random_grid(random, 40, 40, 8);
  const ScanPoints scan = random_points(random, 10, 0.5);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(5, 5, 10, 0.05));
  const WindowTiles tiles(lattice.window());
  const Seeds seeds = coarse_seeds(lattice, tiles, {}, random);
  ASSERT_GE(seeds.chromosomes.size(), 5U);
  for (std::size_t i = 1; i < seeds.chromosomes.size(); ++i)
    EXPECT_EQ(tiles.tile(seeds.chromosomes[i]).theta - tiles.tile(seeds.chromosomes[i - 1]).theta, 4);
  EXPECT_LT(tiles.tile(seeds.chromosomes.front()).theta, -10 + 4);
  EXPECT_GT(tiles.tile(seeds.chromosomes.back()).theta, 10 - 4);
}

TEST(CoarseSeeds, are_few_and_distinct_and_one_of_the_first_is_at_the_robot) {
  const SimulatedWalls walls = furnished_room();
  const ScoreGrid grid = grid_of(walls);
  std::mt19937_64 random(96);
  std::uniform_real_distribution<double> share(-0.9, 0.9);
  for (int trial = 0; trial < 20; ++trial) {
    const mrpt::math::TPose2D truth(4 + share(random), 3 + share(random), 3 * share(random));
    const ScanPoints scan = scan_of(walls, truth, 180, 0.02, random);
    const SearchWindow window = make_search_window({4, 4, 0.5}, 0.05, scan.farthest_m);
    const mrpt::math::TPose2D start(truth.x + 3 * share(random), truth.y + 3 * share(random),
                                    truth.phi + 0.4 * share(random));
    const SearchLattice lattice(grid, scan, start, window);
    const WindowTiles tiles(window);
    MemeticGeneticOptions options;
    options.seeds = 40;
    const Seeds seeds = coarse_seeds(lattice, tiles, options, random);
    EXPECT_LE(seeds.chromosomes.size(), 40U);
    EXPECT_GT(seeds.evaluations, 0);
    EXPECT_EQ(std::set<Chromosome>(seeds.chromosomes.begin(), seeds.chromosomes.end()).size(),
              seeds.chromosomes.size());
    const int x = static_cast<int>(std::lround((truth.x - start.x) / 0.05));
    const int y = static_cast<int>(std::lround((truth.y - start.y) / 0.05));
    const int theta = static_cast<int>(std::lround((truth.phi - start.phi) / window.angular_step_rad));
    bool near = false;
    for (const Chromosome chromosome : seeds.chromosomes) {
      const Tile tile = tiles.tile(chromosome);
      near = near || (std::abs(tile.theta - theta) <= 8 && std::abs(tile.block.first.x + 8 - x) <= 24 &&
                      std::abs(tile.block.first.y + 8 - y) <= 24);
    }
    EXPECT_TRUE(near) << "trial " << trial;
  }
}

}  // namespace
}  // namespace psi_slam
