// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/spanning_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "psi_slam/user_error.h"
#include "test_graphs.h"

namespace psi_slam {
namespace {

void expect_near(const TPose2D& a, const TPose2D& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(wrap_to_pi(a.phi - b.phi), 0, tolerance);
}

TEST(SpanningTree, is_dead_reckoning_where_there_is_odometry) {
  const KnownGraph known = building(200, 2, 2);  // all its poses come from odometry
  const std::vector<TPose2D> poses = spanning_tree_poses(known.graph);
  for (std::size_t node = 0; node < poses.size(); ++node)
    expect_near(poses[node], known.graph.pose(node), 1e-9);
}

TEST(SpanningTree, goes_both_ways_and_over_other_constraints_where_odometry_is_broken) {
  KnownGraph known = ring(50, 3, 0);
  known.graph.set_enabled(20, false);
  for (std::size_t node = 1; node < 50; ++node) known.graph.set_pose(node, {});
  const std::vector<TPose2D> poses = spanning_tree_poses(known.graph);
  for (std::size_t node = 0; node < 50; ++node) expect_near(poses[node], known.truth[node], 1e-9);
}

TEST(SpanningTree, begins_at_the_pose_of_the_root) {
  KnownGraph known = ring(30, 1, 0);
  const TPose2D moved{5, -3, 2};
  known.graph.set_root(12);
  known.graph.set_pose(12, moved);
  const std::vector<TPose2D> poses = spanning_tree_poses(known.graph);
  for (std::size_t node = 0; node < 30; ++node)
    expect_near(poses[node], compose(moved, relative_pose(known.truth[12], known.truth[node])), 1e-9);
}

TEST(SpanningTree, names_a_node_out_of_reach) {
  KnownGraph known = ring(10, 0, 0);
  known.graph.set_enabled(7, false);
  try {
    spanning_tree_poses(known.graph);
    FAIL() << "no exception";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("node 8 of the pose graph is not linked to node 0"));
  }
  EXPECT_TRUE(spanning_tree_poses(PoseGraph()).empty());
}

}  // namespace
}  // namespace psi_slam
