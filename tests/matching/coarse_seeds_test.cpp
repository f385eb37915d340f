// SPDX-License-Identifier: BSD-3-Clause
#include "matching/coarse_seeds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "score_grids.h"

namespace psi_slam {
namespace {

TEST(CoarseSeeds, of_one_block_are_every_few_headings) {
  std::mt19937_64 random(95);
  const ScoreGrid grid = random_grid(random, 40, 40, 8);
  const ScanPoints scan = random_points(random, 10, 0.5);
  const SearchLattice lattice(grid, scan, {0, 0, 0}, window_of_steps(5, 5, 10, 0.05));
  const WindowTiles tiles(lattice.window(), true);
  const Seeds seeds = coarse_seeds(lattice, tiles, {}, random);
  ASSERT_GE(seeds.chromosomes.size(), 5U);
  for (std::size_t i = 1; i < seeds.chromosomes.size(); ++i)
    EXPECT_EQ(tiles.tile(seeds.chromosomes[i]).theta - tiles.tile(seeds.chromosomes[i - 1]).theta, 4);
  EXPECT_LT(tiles.tile(seeds.chromosomes.front()).theta, -10 + 4);
  EXPECT_GT(tiles.tile(seeds.chromosomes.back()).theta, 10 - 4);
}

TEST(CoarseSeeds, are_few_and_differ_and_one_of_the_first_is_where_the_robot_is) {
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
    const WindowTiles tiles(window, true);
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
