// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/scan_comparison.h"

#include <gtest/gtest.h>

#include "two_passes.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

ScanComparison comparison_after(const TPose2D& map_T_true) {
  const MappingResult result = two_passes(map_T_true);
  MapViewOptions options;
  options.step_m = 0;  // every node is a view
  const std::vector<MapView> views = map_views(result, options);
  return compare_scans(views[kScansPerRound], views[1], {});
}

TEST(ScanComparison, finds_the_same_walls) {
  const ScanComparison scans = comparison_after({});
  EXPECT_GT(scans.points, 40U);
  EXPECT_EQ(scans.seen_through, 0U);
  EXPECT_LT(scans.offset_m, 0.02);
  EXPECT_LT(scans.displacement_m, 0.02);
  EXPECT_GT(scans.same_if_moved, 0.95);
}

TEST(ScanComparison, measures_a_displacement) {
  for (const TPose2D& off : {TPose2D(0.3, 0, 0), TPose2D(-0.25, 0.2, 0)}) {
    const ScanComparison scans = comparison_after(off);
    EXPECT_NEAR(scans.displacement_m, std::hypot(off.x, off.y), 0.05);
    EXPECT_GT(scans.same_if_moved, 0.9);
    EXPECT_LT(scans.same, scans.points / 2 + scans.points / 4) << "some walls are displaced";
  }
}

TEST(ScanComparison, measures_a_turn) {
  EXPECT_NEAR(comparison_after({0, 0, 0.05}).turn_rad, 0.05, 0.01);
}

TEST(ScanComparison, sees_through_a_wall_that_moved_into_free_space) {
  EXPECT_EQ(comparison_after({}).seen_through, 0U);
  EXPECT_GT(comparison_after({-0.6, 0, 0}).seen_through, 5U);
}

}  // namespace
}  // namespace psi_slam
