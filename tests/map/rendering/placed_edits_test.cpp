// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/placed_edits.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

MapEdit erase(const TPoint2D& corner) {
  return {MapEdit::Kind::kErase, {corner, {0, 1}, {1, 1}}};
}

std::optional<TPose2D> at_100(std::size_t scan) {
  if (scan == 0) return TPose2D(0, 0, 0);
  return scan == 100 ? std::optional(TPose2D(5, 0, M_PI / 2)) : std::nullopt;
}

TEST(PlacedEdits, an_edit_without_a_frame_has_that_of_the_exported_map) {
  const TPose2D export_T_map(1, 2, 0.3);
  const MapEdit edit = with_frame(erase({3, 4}), export_T_map);
  EXPECT_EQ(edit.frame_T_robot, export_T_map);
  const auto same = placed_edit(edit, export_T_map, at_100);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->points, erase({3, 4}).points) << "bit for bit";
  EXPECT_EQ(with_frame(edit, TPose2D(9, 9, 0)).frame_T_robot, export_T_map) << "a stated frame is kept";
}

TEST(PlacedEdits, an_edit_stays_on_its_wall_when_the_map_turns) {
  const MapEdit edit = with_frame(erase({3, 0}), TPose2D(0, 0, 0));
  const auto turned = placed_edit(edit, TPose2D(1, 0, M_PI / 2), at_100);
  ASSERT_TRUE(turned);
  EXPECT_NEAR(turned->points[0].x, 1, 1e-12);
  EXPECT_NEAR(turned->points[0].y, 3, 1e-12);
  const auto back = placed_edit(*turned, TPose2D(0, 0, 0), at_100);
  EXPECT_NEAR(back->points[0].x, 3, 1e-12);
  EXPECT_NEAR(back->points[0].y, 0, 1e-12);
}

TEST(PlacedEdits, an_edit_follows_the_first_scan_to_a_stated_frame) {
  const MapEdit edit = with_frame(erase({2, 0}), TPose2D(0, 0, 0));  // 2 m ahead of the first scan
  const auto placed = placed_edit(edit, TPose2D(0, 0, 0),
                                  [](std::size_t) { return std::optional(TPose2D(40, -7, M_PI / 2)); });
  ASSERT_TRUE(placed);
  EXPECT_NEAR(placed->points[0].x, 40, 1e-12);
  EXPECT_NEAR(placed->points[0].y, -5, 1e-12);
}

TEST(PlacedEdits, an_edit_of_a_later_run_follows_the_pose_of_its_scan) {
  MapEdit edit = with_frame(erase({2, 0}), TPose2D(0, 0, 0));  // 2 m ahead of the robot
  edit.scan = 100;
  const auto placed = placed_edit(edit, TPose2D(0, 1, 0), at_100);
  ASSERT_TRUE(placed);
  EXPECT_NEAR(placed->points[0].x, 5, 1e-12);
  EXPECT_NEAR(placed->points[0].y, 3, 1e-12);
  edit.scan = 101;
  EXPECT_FALSE(placed_edit(edit, TPose2D(0, 1, 0), at_100)) << "the scan is not mapped";
}

}  // namespace
}  // namespace psi_slam
