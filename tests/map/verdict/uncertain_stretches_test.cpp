// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/uncertain_stretches.h"

#include <gtest/gtest.h>

#include "two_passes.h"

namespace psi_slam {
namespace {

TEST(UncertainStretches, lie_between_the_ends_of_loops) {
  MappingResult result = two_passes();
  const std::vector<MapView> views = map_views(result);
  ASSERT_GT(views.size(), 24U);
  std::vector<std::optional<double>> sigmas_m(views.size(), 0.1);
  sigmas_m[10] = 0.3;
  sigmas_m[11] = 0.5;
  sigmas_m[12] = 0.4;
  sigmas_m[22] = 0.3;
  sigmas_m[20].reset();
  const std::size_t worst = views[11].frame;
  result.loops = {loop_between(result, worst - 5, worst + 8), loop_between(result, 0, worst + 20)};
  const auto stretches = uncertain_stretches(result, views, sigmas_m, 0.25);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].worst, 11U);
  EXPECT_EQ(stretches[0].sigma_m, 0.5);
  EXPECT_NEAR(stretches[0].length_m, views[12].travelled_m - views[10].travelled_m, 1e-9);
  EXPECT_EQ(stretches[0].first_frame, worst - 5);
  EXPECT_EQ(stretches[0].last_frame, worst + 8);
  EXPECT_EQ(stretches[1].worst, 22U);
}

TEST(UncertainStretches, are_whole_runs_without_loops) {
  MappingResult result = two_passes();
  result.later_run_frames = {kScansPerRound};
  const std::vector<MapView> views = map_views(result);
  const std::vector<std::optional<double>> sigmas_m(views.size(), 1.0);
  const auto stretches = uncertain_stretches(result, views, sigmas_m, 0.25);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].first_frame, 0U);
  EXPECT_EQ(stretches[0].last_frame, kScansPerRound - 1U);
  EXPECT_EQ(stretches[1].first_frame, static_cast<std::size_t>(kScansPerRound));
  EXPECT_EQ(stretches[1].last_frame, 2U * kScansPerRound - 1);
}

}  // namespace
}  // namespace psi_slam
