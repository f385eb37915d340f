// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/grazed_wall.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(GrazedWall, passes_through_ends_on_a_line_except_for_noise) {
  const auto wall = grazed_wall({{{10, 1}, {12, 1.03}, {15, 0.98}, {20, 1}}});
  ASSERT_TRUE(wall);
  EXPECT_DOUBLE_EQ(wall->normal.x, 0);
  EXPECT_DOUBLE_EQ(wall->normal.y, 1);
  EXPECT_NEAR(wall->offset_m, 0.03, 1e-12);
}

TEST(GrazedWall, needs_ends_that_are_spread_along_a_line) {
  EXPECT_FALSE(grazed_wall({{{10, 1}, {12, 1.06}, {15, 1}, {20, 1}}})) << "an end is off the line";
  EXPECT_FALSE(grazed_wall({{{10, 1}, {10.1, 1}, {10.2, 1}, {20, 1}}})) << "three ends are on one object";
  EXPECT_FALSE(grazed_wall({{{10, 1}, {12, 1}, {15, 1}, {11, 1}}})) << "the ends turn back";
  EXPECT_FALSE(grazed_wall({{{10, 1}, {10, 1}, {10, 1}, {10, 1}}})) << "the ends are at one place";
}

}  // namespace
}  // namespace psi_slam
