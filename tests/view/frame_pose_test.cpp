// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/view/frame_pose.h"

#include <cmath>

#include "replayed_room.h"

namespace psi_slam {
namespace {

class FramePoseTest : public ReplayedRoom {};

TEST_F(FramePoseTest, nodes_are_where_the_graph_has_them_and_scans_between_near_where_the_map_has_them) {
  for (std::size_t i = 0; i < finished_->nodes.size(); ++i) {
    const mrpt::math::TPose2D pose = map_T_frame(*finished_, finished_->nodes[i].frame);
    EXPECT_NEAR(pose.x, (*finished_->map_T_node)[i].x, 1e-9);
    EXPECT_NEAR(pose.y, (*finished_->map_T_node)[i].y, 1e-9);
  }
  for (std::size_t i = 0; i < finished_->frames.size(); ++i) {
    const mrpt::math::TPose2D off = map_T_frame(*finished_, i) - finished_->frames[i].map_T_robot;
    EXPECT_LT(std::hypot(off.x, off.y), 0.05) << i;
  }
}

}  // namespace
}  // namespace psi_slam
