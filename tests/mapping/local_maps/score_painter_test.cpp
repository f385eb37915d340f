// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/score_painter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;

Grid grid_of_cells(int width, int height) {
  Grid grid(0, static_cast<float>(0.05 * width), 0, static_cast<float>(0.05 * height), 0.05F);
  EXPECT_EQ(static_cast<int>(grid.getSizeX()), width);
  EXPECT_EQ(static_cast<int>(grid.getSizeY()), height);
  return grid;
}

void occupy(Grid& grid, int x, int y, double probability) {
  grid.setCell(x, y, static_cast<float>(1 - probability));  // MRPT stores the probability of being free
}

// Grid in which each cell has a random occupancy with probability `share`. The other cells are unknown.
Grid random_grid(std::mt19937_64& random, int width, int height, double share) {
  Grid grid = grid_of_cells(width, height);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (uniform(random) < share) occupy(grid, x, y, uniform(random));
  return grid;
}

// Returns the evidence of every cell, computed by a painter without smoothing.
std::vector<int> evidence_of(const Grid& grid) {
  const int width = static_cast<int>(grid.getSizeX());
  const int height = static_cast<int>(grid.getSizeY());
  ScoreLevel scores(width, height, 1);
  ScorePainter(1e-4, 0.05).paint(grid, 0, 0, width, height, scores);
  std::vector<int> evidence;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) evidence.push_back(scores.at(x, y));
  return evidence;
}

TEST(ScorePainter, evidence_grows_with_occupancy_above_unknown) {
  Grid grid = grid_of_cells(101, 1);
  for (int i = 0; i <= 100; ++i) occupy(grid, i, 0, 0.01 * i);
  const std::vector<int> evidence = evidence_of(grid);
  for (int i = 0; i <= 50; ++i) EXPECT_EQ(evidence[i], 0) << "free or unknown, " << i << " %";
  for (int i = 51; i <= 100; ++i) EXPECT_GE(evidence[i], evidence[i - 1]) << i << " %";
  EXPECT_GT(evidence[60], 0);
  EXPECT_LT(evidence[60], 255);
  EXPECT_EQ(evidence[95], 255);
}

TEST(ScorePainter, equals_a_slow_dense_gaussian) {
  std::mt19937_64 random(11);
  for (const double sigma_m : {0.03, 0.05, 0.08, 0.12}) {
    const int width = 45;
    const int height = 37;
    const Grid grid = random_grid(random, width, height, 0.15);
    const std::vector<int> evidence = evidence_of(grid);
    ScorePainter painter(sigma_m, 0.05);
    ScoreLevel scores(width, height, 1);
    painter.paint(grid, 0, 0, width, height, scores);

    const int reach = painter.reach_cells();
    const double sigma_cells = sigma_m / 0.05;
    EXPECT_GE(reach, 2 * sigma_cells) << "beyond the reach, the kernel is below 0.14";
    const auto gauss = [&](int d) { return std::exp(-0.5 * d * d / (sigma_cells * sigma_cells)); };
    double line = 0;
    for (int d = -reach; d <= reach; ++d) line += gauss(d);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double expected = 0;
        int contributions = 0;
        for (int cy = std::max(0, y - reach); cy <= std::min(height - 1, y + reach); ++cy) {
          for (int cx = std::max(0, x - reach); cx <= std::min(width - 1, x + reach); ++cx) {
            const int here = evidence[static_cast<std::size_t>(cy * width + cx)];
            expected += here * gauss(cx - x) * gauss(cy - y) / line;
            if (here > 0) ++contributions;
          }
        }
        // The painter computes with integers. Each contribution can lose up to 1, and 0.5 by rounding its
        // weight.
        ASSERT_NEAR(scores.at(x, y), std::min(expected, 255.0), 0.5 + 1.5 * contributions)
            << "sigma " << sigma_m << " at " << x << ", " << y;
        ASSERT_TRUE(contributions > 0 || scores.at(x, y) == 0);
      }
    }
  }
}

TEST(ScorePainter, a_straight_wall_one_cell_thick_scores_one_in_its_middle) {
  for (const double sigma_m : {0.03, 0.05, 0.1}) {
    Grid grid = grid_of_cells(60, 41);
    for (int x = 0; x < 60; ++x) occupy(grid, x, 20, 0.99);
    ScorePainter painter(sigma_m, 0.05);
    ScoreLevel scores(60, 41, 1);
    painter.paint(grid, 0, 0, 60, 41, scores);
    const double rounding = 1.5 * (2 * painter.reach_cells() + 1);  // 1.5 for each contributing cell
    EXPECT_GE(scores.at(30, 20), 255 - rounding);
    const double sigma_cells = sigma_m / 0.05;
    for (int d = 1; d <= painter.reach_cells(); ++d) {
      const double expected = 255 * std::exp(-0.5 * d * d / (sigma_cells * sigma_cells));
      EXPECT_NEAR(scores.at(30, 20 + d), expected, rounding) << d << " cells beside it";
      EXPECT_EQ(scores.at(30, 20 + d), scores.at(30, 20 - d));
    }
    EXPECT_EQ(scores.at(30, 21 + painter.reach_cells()), 0);
  }
}

TEST(ScorePainter, repainting_a_part_equals_painting_the_whole) {
  std::mt19937_64 random(12);
  const int width = 50;
  const int height = 40;
  ScorePainter painter(0.05, 0.05);
  for (int trial = 0; trial < 200; ++trial) {
    const Grid before = random_grid(random, width, height, 0.1);
    const Grid after = random_grid(random, width, height, 0.1);
    ScoreLevel old_scores(width, height, 1);
    painter.paint(before, 0, 0, width, height, old_scores);
    ScoreLevel new_scores(width, height, 1);
    painter.paint(after, 0, 0, width, height, new_scores);

    const auto x =
        std::minmax({static_cast<int>(random() % (width + 1)), static_cast<int>(random() % (width + 1))});
    const auto y =
        std::minmax({static_cast<int>(random() % (height + 1)), static_cast<int>(random() % (height + 1))});
    ScoreLevel repainted = old_scores;
    painter.paint(after, x.first, y.first, x.second, y.second, repainted);
    for (int cy = -3; cy < height + 3; ++cy) {
      for (int cx = -3; cx < width + 3; ++cx) {
        const bool within = cx >= x.first && cx < x.second && cy >= y.first && cy < y.second;
        ASSERT_EQ(repainted.at(cx, cy), (within ? new_scores : old_scores).at(cx, cy))
            << cx << ", " << cy << " of [" << x.first << ", " << x.second << ") x [" << y.first << ", "
            << y.second << ")";
      }
    }
  }
}

TEST(ScorePainter, a_solid_block_does_not_overflow) {
  for (const double sigma_m : {0.05, 0.5}) {
    Grid grid = grid_of_cells(80, 80);
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 80; ++x) occupy(grid, x, y, 0.99);
    ScoreLevel scores(80, 80, 1);
    ScorePainter(sigma_m, 0.05).paint(grid, 0, 0, 80, 80, scores);
    for (int i = 30; i < 50; ++i) EXPECT_EQ(scores.at(i, i), 255);
  }
}

}  // namespace
}  // namespace psi_slam
