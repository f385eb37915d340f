// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/obstacle_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

namespace psi_slam {
namespace {

// Compares with a search of all occupied cells, in maps with many, few and no obstacles.
TEST(ObstacleField, numbers_obstacles_and_measures_distances_as_exhaustive_search_does) {
  std::mt19937 random(1);
  for (const int one_in : {2, 40, 2000, 1'000'000}) {
    mrpt::maps::COccupancyGridMap2D grid(0, 37 * 0.1F, 0, 53 * 0.1F, 0.1F);
    const int width = static_cast<int>(grid.getSizeX());
    const int height = static_cast<int>(grid.getSizeY());
    std::vector<std::pair<int, int>> occupied;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const bool is_occupied = random() % static_cast<unsigned>(one_in) == 0;
        grid.setCell(x, y, is_occupied ? 0.1F : 0.9F);
        if (is_occupied) occupied.emplace_back(x, y);
      }
    const ObstacleField field(grid);
    int number = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        int nearest = 255;
        for (const auto& [other_x, other_y] : occupied)
          nearest = std::min(nearest, std::max(std::abs(other_x - x), std::abs(other_y - y)));
        const int expected = nearest == 0 ? number++ : -nearest;
        ASSERT_EQ(field.find(static_cast<std::size_t>(y * width + x)), expected)
            << "cell (" << x << ", " << y << "), one obstacle in " << one_in << " cells";
      }
  }
}

TEST(ObstacleField, distances_end_at_255_cells) {
  mrpt::maps::COccupancyGridMap2D grid(0, 60, 0, 0.5F, 0.1F);
  for (unsigned y = 0; y < grid.getSizeY(); ++y)
    for (unsigned x = 0; x < grid.getSizeX(); ++x)
      grid.setCell(static_cast<int>(x), static_cast<int>(y), 0.9F);
  grid.setCell(0, 0, 0.1F);
  const ObstacleField field(grid);
  EXPECT_EQ(field.find(0), 0);
  EXPECT_EQ(field.find(254), -254);
  EXPECT_EQ(field.find(300), -255);
}

}  // namespace
}  // namespace psi_slam
