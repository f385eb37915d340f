// SPDX-License-Identifier: BSD-3-Clause
#include "matching/tile_space.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <tuple>

#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

using Key = std::tuple<int, int, int>;

Key key(const Tile& tile) {
  return {tile.theta, tile.block.first.x, tile.block.first.y};
}

// Returns all tiles of a space by decoding all strings of bits. Checks each chromosome.
std::map<Key, Tile> all_tiles(const TileSpace& space) {
  std::map<Key, Tile> tiles;
  std::map<Key, Chromosome> code_of;
  for (Chromosome chromosome = 0; chromosome < (Chromosome{1} << space.bits()); ++chromosome) {
    const Chromosome repaired = space.repaired(chromosome);
    EXPECT_EQ(code_of.emplace(key(space.tile(chromosome)), repaired).first->second, repaired)
        << "each tile has only one repaired chromosome";
    EXPECT_EQ(space.repaired(repaired), repaired);
    EXPECT_EQ(repaired >> space.bits(), 0U);
    EXPECT_EQ(key(space.tile(chromosome)), key(space.tile(repaired)));
    tiles.emplace(key(space.tile(chromosome)), space.tile(chromosome));
  }
  return tiles;
}

TEST(WindowTiles, cover_every_pose_of_the_window_once) {
  for (const SearchWindow& window : {window_of_steps(3, 5, 4, 0.01), window_of_steps(16, 16, 3, 0.01),
                                     window_of_steps(20, 17, 2, 0.01), window_of_steps(40, 5, 6, 0.01)}) {
    const WindowTiles space(window);
    const std::map<Key, Tile> tiles = all_tiles(space);
    EXPECT_EQ(static_cast<std::int64_t>(tiles.size()), space.size());
    std::map<Key, int> covered;
    for (const auto& [name, tile] : tiles)
      for (int y = 0; y < tile.block.height; ++y)
        for (int x = 0; x < tile.block.width; ++x)
          ++covered[{tile.theta, tile.block.first.x + x, tile.block.first.y + y}];
    const auto poses = static_cast<std::size_t>((2 * window.n_x + 1) * (2 * window.n_y + 1)) *
                       static_cast<std::size_t>(2 * window.n_theta + 1);
    EXPECT_EQ(covered.size(), poses);
    for (const auto& [pose, times] : covered) {
      EXPECT_EQ(times, 1);
      EXPECT_LE(std::abs(std::get<0>(pose)), window.n_theta);
      EXPECT_LE(std::abs(std::get<1>(pose)), window.n_x);
      EXPECT_LE(std::abs(std::get<2>(pose)), window.n_y);
    }
  }
}

TEST(WindowTiles, small_windows_are_one_block) {
  const WindowTiles small(window_of_steps(15, 4, 3, 0.01));
  EXPECT_EQ(small.columns() * small.rows(), 1);
  EXPECT_EQ(small.size(), 7);
  const WindowTiles large(window_of_steps(16, 4, 3, 0.01));
  EXPECT_EQ(large.columns(), 3);
  EXPECT_EQ(large.rows(), 1);
}

TEST(WindowTiles, encode_gives_the_block_that_contains_a_shift) {
  const SearchWindow window = window_of_steps(40, 30, 6, 0.01);
  const WindowTiles space(window);
  for (int y = -30; y <= 30; y += 7)
    for (int x = -40; x <= 40; x += 9) {
      const Tile tile = space.tile(space.encode(-5, space.column_of(x), space.row_of(y)));
      EXPECT_EQ(tile.theta, -5);
      EXPECT_TRUE(tile.block.first.x <= x && x < tile.block.first.x + tile.block.width);
      EXPECT_TRUE(tile.block.first.y <= y && y < tile.block.first.y + tile.block.height);
    }
}

int bits_set(Chromosome chromosome) {
  int count = 0;
  for (; chromosome != 0; chromosome &= chromosome - 1) ++count;
  return count;
}

TEST(WindowTiles, a_step_along_an_axis_is_one_bit) {
  const WindowTiles space(window_of_steps(80, 80, 20, 0.01));
  for (int theta = -20; theta < 20; ++theta)
    EXPECT_EQ(bits_set(space.encode(theta, 3, 4) ^ space.encode(theta + 1, 3, 4)), 1);
  for (int i = 0; i + 1 < space.columns(); ++i) {
    EXPECT_EQ(bits_set(space.encode(0, i, 4) ^ space.encode(0, i + 1, 4)), 1);
    EXPECT_EQ(bits_set(space.encode(0, 3, i) ^ space.encode(0, 3, i + 1)), 1);
  }
}

TEST(WindowTiles, turn_up_to_the_windows_edge) {
  const WindowTiles space(window_of_steps(40, 30, 6, 0.01));
  const Chromosome here = space.encode(4, 1, 2);
  EXPECT_EQ(space.turned(here, 2), space.encode(6, 1, 2));
  EXPECT_EQ(space.turned(here, -10), space.encode(-6, 1, 2));
  EXPECT_FALSE(space.turned(here, 3));
  EXPECT_FALSE(space.turned(here, -11));
}

TEST(CellTiles, contain_all_headings_of_their_cells_inside_the_window) {
  const SearchWindow window = window_of_steps(40, 40, 10, 0.01);
  const std::vector<Tile> cells = {{0, {{-8, 0}, 8, 8}}, {9, {{16, -40}, 8, 8}}, {-10, {{32, 8}, 8, 5}}};
  const CellTiles space(window, cells);
  EXPECT_EQ(space.size(), 12);
  const std::map<Key, Tile> tiles = all_tiles(space);
  std::set<Key> expected;
  for (const Tile& cell : cells)
    for (int turn = -2; turn < 2; ++turn)
      expected.insert({std::clamp(cell.theta + turn, -10, 10), cell.block.first.x, cell.block.first.y});
  ASSERT_EQ(tiles.size(), expected.size());
  for (const auto& [name, tile] : tiles) {
    EXPECT_EQ(expected.count(name), 1U);
    EXPECT_EQ(tile.block.height, tile.block.first.x == 32 ? 5 : 8);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(key(space.tile(space.encode(i))), key(cells[i]));
  EXPECT_EQ(key(space.tile(*space.turned(space.encode(0), 1))), Key(1, -8, 0));
  EXPECT_EQ(key(space.tile(*space.turned(space.encode(0), -2))), Key(-2, -8, 0));
  EXPECT_FALSE(space.turned(space.encode(0), 2)) << "outside the cell";
  EXPECT_FALSE(space.turned(space.encode(2), -1)) << "outside the window";
}

struct TileProblem {
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
  const TileProblem problem;
  TileScorer scorer(problem.lattice);
  const WindowTiles space(problem.lattice.window());
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
  const TileProblem problem;
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
  const TileProblem problem;
  TileScorer scorer(problem.lattice);
  scorer.score({0, {{0, 0}, 7, 5}}, TileLevel::kFinest);
  EXPECT_EQ(scorer.evaluations(), 35);
  scorer.score({0, {{0, 0}, 7, 5}}, TileLevel::kPooled);
  EXPECT_EQ(scorer.evaluations(), 35 + 4 * 3);
}

}  // namespace
}  // namespace psi_slam
