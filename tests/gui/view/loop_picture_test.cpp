// SPDX-License-Identifier: BSD-3-Clause
#include "gui/loop_picture.h"

#include <cmath>

#include "replayed_room.h"

namespace psi_slam {
namespace {

class LoopPictureTest : public ReplayedRoom {
 protected:
  /// Mean darkness of the local map at the points, from 0 (white) to 1 (black).
  static double mean_darkness(const MapRaster& map, const std::vector<mrpt::math::TPoint2D>& points) {
    double sum = 0;
    for (const mrpt::math::TPoint2D& point : points) {
      const auto column = static_cast<int>((point.x - map.x_min_m) / map.resolution_m);
      const auto row = static_cast<int>((map.y_max_m - point.y) / map.resolution_m);
      if (column < 0 || row < 0 || column >= map.width_px || row >= map.height_px) continue;
      sum += 1 - map.pixels[4 * static_cast<std::size_t>(row * map.width_px + column)] / 255.0;
    }
    return sum / static_cast<double>(points.size());
  }
};

TEST_F(LoopPictureTest, at_its_matched_pose_the_scan_lies_on_the_walls_of_the_local_map) {
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < finished_->loops->size(); ++i) {
    const LoopRecord& loop = (*finished_->loops)[i];
    if (loop.state != LoopState::kAccepted) continue;
    ++accepted;
    const std::optional<LoopPicture> picture = loop_picture(*finished_, i);
    ASSERT_TRUE(picture.has_value());
    EXPECT_EQ(picture->before.size(), picture->after.size());
    const double after = mean_darkness(picture->local_map, picture->after);
    EXPECT_GT(after, 0.4 * loop.response) << "the response counts points on walls";
    EXPECT_GE(after, mean_darkness(picture->local_map, picture->before) - 0.1);
    const auto moved = picture->after.front() - picture->before.front();
    EXPECT_LT(moved.norm(), 2.0);
  }
  EXPECT_GT(accepted, 0U);
}

TEST_F(LoopPictureTest, is_missing_for_a_missing_loop) {
  EXPECT_FALSE(loop_picture(*finished_, finished_->loops->size()).has_value());
  EXPECT_FALSE(loop_picture(ReplaySnapshot{}, 0).has_value());
}

TEST_F(LoopPictureTest, residuals_of_true_loops_are_small) {
  for (const LoopRecord& loop : *finished_->loops)
    if (loop.state == LoopState::kAccepted) {
      EXPECT_LT(loop_residual_m(loop, *finished_->map_T_node), 0.1);
    }
}

TEST(LoopResidual, is_the_error_of_the_node) {
  LoopRecord loop;
  loop.reference = 0;
  loop.node = 1;
  loop.reference_T_node = {1, 0, 0};
  EXPECT_NEAR(loop_residual_m(loop, {{5, 5, M_PI / 2}, {5, 6.3, M_PI / 2 + 0.1}}), 0.3, 1e-12);
}

}  // namespace
}  // namespace psi_slam
