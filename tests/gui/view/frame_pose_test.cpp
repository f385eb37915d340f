// SPDX-License-Identifier: BSD-3-Clause
#include "gui/replay_snapshot.h"

#include <cmath>

#include "replayed_room.h"

namespace psi_slam {
namespace {

class FramePoseTest : public ReplayedRoom {};

TEST_F(FramePoseTest, before_the_end_nodes_have_graph_poses_and_other_scans_are_within_5_cm_of_the_result) {
  ReplaySnapshot open = *finished_;
  open.phase = ReplayPhase::kFinalSearch;
  SharedHistory<NodeScan> nodes;  // holds every fourth node of the run
  std::vector<mrpt::math::TPose2D> poses;
  for (std::size_t i = 0; i < finished_->nodes.size(); i += 4) {
    nodes.push_back(finished_->nodes[i]);
    poses.push_back((*finished_->map_T_node)[i]);
  }
  open.nodes = nodes.view();
  open.map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(poses);
  for (std::size_t i = 0; i < open.frames.size(); ++i) {
    const mrpt::math::TPose2D off = map_T_frame(open, i) - finished_->frames[i].map_T_robot;
    EXPECT_LT(std::hypot(off.x, off.y), 0.05) << i;
  }
  for (std::size_t i = 0; i < open.nodes.size(); ++i) {
    const mrpt::math::TPose2D pose = map_T_frame(open, open.nodes[i].frame);
    EXPECT_NEAR(pose.x, (*open.map_T_node)[i].x, 1e-9);
    EXPECT_NEAR(pose.y, (*open.map_T_node)[i].y, 1e-9);
  }
  EXPECT_LT(open.nodes.size(), open.frames.size() / 3);
}

TEST_F(FramePoseTest, after_the_end_all_scans_have_the_poses_of_the_result) {
  ReplaySnapshot moved = *finished_;
  auto nodes = *moved.map_T_node;
  for (mrpt::math::TPose2D& node : nodes) node.x += 5;
  moved.map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(nodes);
  for (std::size_t i = 0; i < moved.frames.size(); ++i)
    EXPECT_EQ(map_T_frame(moved, i), moved.frames[i].map_T_robot);
}

}  // namespace
}  // namespace psi_slam
