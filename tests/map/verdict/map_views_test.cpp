// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/map_views.h"

#include <gtest/gtest.h>

#include "two_passes.h"

namespace psi_slam {
namespace {

TEST(MapViews, are_at_steps_of_the_path) {
  const MappingResult result = two_passes();
  const std::vector<MapView> views = map_views(result);
  ASSERT_GT(views.size(), 20U);
  for (std::size_t i = 1; i < views.size(); ++i)
    EXPECT_TRUE(views[i].travelled_m - views[i - 1].travelled_m >= 0.5 ||
                std::abs(std::remainder(views[i].map_T_robot.phi - views[i - 1].map_T_robot.phi, 2 * M_PI)) >=
                    0.5);
  EXPECT_NEAR(views.back().travelled_m, 2 * 9.7, 1) << "two rounds of an ellipse";
  EXPECT_TRUE(are_different_passes(views.front(), views.back(), 8));
  EXPECT_FALSE(are_different_passes(views[0], views[1], 8));
}

TEST(MapViews, leave_out_scans_without_ranges) {
  MappingResult result = two_passes();
  const std::size_t all = map_views(result).size();
  for (int i = 0; i < kScansPerRound; ++i) result.log[static_cast<std::size_t>(i)].scan.ranges_m.clear();
  EXPECT_LT(map_views(result).size(), all * 3 / 4);
  EXPECT_TRUE(map_views(MappingResult{}).empty());
}

TEST(MapViews, begin_a_new_path_with_each_run) {
  MappingResult result = two_passes();
  result.later_run_frames = {kScansPerRound};
  const std::vector<MapView> views = map_views(result);
  EXPECT_EQ(views.front().run, 0U);
  EXPECT_EQ(views.back().run, 1U);
  EXPECT_LT(views.back().travelled_m, 10);
}

}  // namespace
}  // namespace psi_slam
