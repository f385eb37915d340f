// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/local_map_constraints.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(ConstrainToLocalMaps, ties_the_node_to_the_anchor_of_each_with_the_noise_added) {
  PoseGraph graph;
  for (const double x_m : {0.0, 1.0, 2.0}) graph.add_node({x_m, 0, 0});
  FrontEndStep step;
  step.node = 2;
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.03 * 0.03, 0.03 * 0.03, 0).asDiagonal();
  step.memberships = {{5, 0, {2.1, 0, 0}, covariance}, {6, 1, {1.2, 0, 0}, covariance}};
  constrain_to_local_maps(step, {0.04, 0.1}, graph);

  ASSERT_EQ(graph.num_constraints(), 2u);
  const Constraint& older = graph.constraint(0);
  EXPECT_EQ(older.kind, Constraint::Kind::kLocalMap);
  EXPECT_EQ(older.from, 0u);
  EXPECT_EQ(older.to, 2u);
  EXPECT_EQ(older.from_T_to, (mrpt::math::TPose2D{2.1, 0, 0}));
  EXPECT_EQ(graph.constraint(1).from, 1u);
  const Eigen::Matrix3d expected = Eigen::Vector3d(400, 400, 100).asDiagonal();
  EXPECT_TRUE(older.information.isApprox(expected, 1e-9)) << older.information;
}

TEST(ConstrainToLocalMaps, leaves_the_graph_alone_where_the_scan_was_inserted_into_none) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  FrontEndStep step;
  step.node = 0;
  constrain_to_local_maps(step, {0.04, 0.1}, graph);
  EXPECT_EQ(graph.num_constraints(), 0u);
}

}  // namespace
}  // namespace psi_slam
