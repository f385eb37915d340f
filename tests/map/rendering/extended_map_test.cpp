// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/extended_map.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

COccupancyGridMap2D grid_from(float x_min_m, float x_max_m, float cell) {
  COccupancyGridMap2D grid;
  grid.setSize(x_min_m, x_max_m, 0, 1, 0.1F, 0.5F);
  for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x) grid.setCell(x, y, cell);
  return grid;
}

TEST(ExtendedMap, keeps_the_known_cells_and_takes_the_others) {
  COccupancyGridMap2D prior = grid_from(-1, 1, 0.9F);
  prior.setCell(prior.x2idx(0.55), prior.y2idx(0.55), 0.5F);  // unknown
  const COccupancyGridMap2D further = grid_from(0, 3, 0.1F);
  const auto both = extended_map(prior, further);
  EXPECT_FLOAT_EQ(both->getXMin(), -1);
  EXPECT_FLOAT_EQ(both->getXMax(), 3);
  EXPECT_NEAR(both->getPos(-0.95F, 0.45F), 0.9, 0.02);
  EXPECT_NEAR(both->getPos(0.95F, 0.45F), 0.9, 0.02);
  EXPECT_NEAR(both->getPos(0.55F, 0.55F), 0.1, 0.02);
  EXPECT_NEAR(both->getPos(1.05F, 0.45F), 0.1, 0.02);
  EXPECT_NEAR(both->getPos(2.95F, 0.95F), 0.1, 0.02);
}

TEST(ExtendedMap, refuses_other_cells) {
  COccupancyGridMap2D coarse;
  coarse.setSize(0, 1, 0, 1, 0.2F, 0.5F);
  EXPECT_THROW(extended_map(grid_from(0, 1, 0.9F), coarse), std::invalid_argument);
}

}  // namespace
}  // namespace psi_slam
