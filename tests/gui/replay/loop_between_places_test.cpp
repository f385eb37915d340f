// SPDX-License-Identifier: BSD-3-Clause
#include "gui/loop_between_places.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// A path with two legs of ten nodes along x; the second leg is at y = 20 m. It has three local maps.
class LoopBetweenPlacesTest : public testing::Test {
 protected:
  LoopBetweenPlacesTest() {
    auto poses = std::make_shared<std::vector<TPose2D>>();
    for (std::size_t i = 0; i < 20; ++i) {
      const double x = static_cast<double>(i % 10);
      poses->push_back({10 * x, i < 10 ? 0.0 : 20.0, i < 10 ? 0.0 : 0.1});
      NodeScan node;
      node.frame = 5 * i;
      nodes_.push_back(node);
    }
    local_maps_.push_back({0, 0, 5});
    local_maps_.push_back({3, 3, 9});
    local_maps_.push_back({10, 10, 19});
    snapshot_.map_T_node = poses;
    snapshot_.nodes = nodes_.view();
    snapshot_.local_maps = local_maps_.view();
  }

  SharedHistory<NodeScan> nodes_;
  SharedHistory<LocalMapRecord> local_maps_;
  ReplaySnapshot snapshot_;
};

TEST_F(LoopBetweenPlacesTest, takes_the_scan_near_the_first_place_and_the_local_map_near_the_second) {
  const auto edit = loop_between_places(snapshot_, {81, 20.5}, {79, 0.5}, MatcherKind::kGa);
  ASSERT_TRUE(edit.has_value());
  EXPECT_EQ(edit->kind, LoopEdit::Kind::kMatch);
  EXPECT_EQ(edit->frame, 5U * 18);
  EXPECT_EQ(edit->local_map, 1U);
  EXPECT_EQ(edit->matcher, MatcherKind::kGa);
  ASSERT_TRUE(edit->place.has_value());
  // The node is at (80, 20). Moved by (-2, -20), it is at (78, 0), 48 m ahead of the anchor at (30, 0).
  EXPECT_NEAR(edit->place->anchor_T_node.x, 48, 1e-9);
  EXPECT_NEAR(edit->place->anchor_T_node.y, 0, 1e-9);
  EXPECT_NEAR(edit->place->anchor_T_node.phi, 0.1, 1e-9);
  EXPECT_EQ(edit->place->window.x_m, kClickedWindow_m);
}

TEST_F(LoopBetweenPlacesTest, where_two_passes_overlap_takes_the_newest_scan_and_the_oldest_local_map) {
  auto poses = std::make_shared<std::vector<TPose2D>>(*snapshot_.map_T_node);
  for (std::size_t i = 10; i < 20; ++i) (*poses)[i] = {(*poses)[i - 10].x + 0.5, 0.3, 0};
  snapshot_.map_T_node = poses;
  const auto edit = loop_between_places(snapshot_, {40, 0}, {40, 0}, MatcherKind::kCsm);
  ASSERT_TRUE(edit.has_value());
  EXPECT_EQ(edit->frame, 5U * 14);
  EXPECT_EQ(edit->local_map, 0U);
  EXPECT_NEAR(edit->place->anchor_T_node.x, 40.5, 1e-9) << "the scan is not moved";
}

TEST_F(LoopBetweenPlacesTest, far_from_all_scans_takes_the_nearest) {
  const auto edit = loop_between_places(snapshot_, {200, 40}, {-50, -9}, MatcherKind::kCsm);
  ASSERT_TRUE(edit.has_value());
  EXPECT_EQ(edit->frame, 5U * 19);
  EXPECT_EQ(edit->local_map, 0U);
}

TEST_F(LoopBetweenPlacesTest, does_not_match_a_scan_with_its_own_local_map) {
  const auto edit = loop_between_places(snapshot_, {0, 0}, {0, 0}, MatcherKind::kCsm);
  ASSERT_TRUE(edit.has_value());
  EXPECT_EQ(edit->frame, 0U);
  EXPECT_NE(edit->local_map, 0U);
}

TEST_F(LoopBetweenPlacesTest, returns_nothing_without_another_local_map) {
  EXPECT_FALSE(loop_between_places(ReplaySnapshot(), {0, 0}, {1, 1}, MatcherKind::kCsm).has_value());
  SharedHistory<LocalMapRecord> one;
  one.push_back({0, 0, 19});
  snapshot_.local_maps = one.view();
  EXPECT_FALSE(loop_between_places(snapshot_, {0, 0}, {1, 1}, MatcherKind::kCsm).has_value());
}

}  // namespace
}  // namespace psi_slam
