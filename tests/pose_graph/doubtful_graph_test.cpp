// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/doubtful_graph.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "test_graphs.h"

namespace psi_slam {
namespace {

TEST(DoubtfulGraph, has_the_covariances_with_doubt_and_everything_else_of_the_graph) {
  PoseGraph graph = building(60, 1, 3, 1).graph;
  Constraint uncertain = graph.constraint(4);
  uncertain.doubt << 0.3, 0.1, 0, 0.1, 0.2, 0, 0, 0, 0.05;
  const std::size_t index = graph.add_constraint(uncertain);
  graph.set_enabled(7, false);
  graph.set_root(3);
  const PoseGraph doubtful = doubtful_graph(graph);
  EXPECT_EQ(doubtful.root(), 3U);
  ASSERT_EQ(doubtful.num_nodes(), graph.num_nodes());
  for (std::size_t i = 0; i < graph.num_nodes(); ++i) EXPECT_EQ(doubtful.pose(i), graph.pose(i));
  ASSERT_EQ(doubtful.num_constraints(), graph.num_constraints());
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    const Constraint& one = doubtful.constraint(i);
    EXPECT_EQ(doubtful.enabled(i), i != 7);
    EXPECT_EQ(one.from_T_to, graph.constraint(i).from_T_to);
    if (i == index) continue;
    EXPECT_EQ(one.information, graph.constraint(i).information);
  }
  const Eigen::Matrix3d expected = uncertain.information.inverse() + uncertain.doubt;
  EXPECT_TRUE(doubtful.constraint(index).information.inverse().isApprox(expected, 1e-9));
}

TEST(DoubtfulGraph, of_an_empty_graph_is_empty) {
  EXPECT_EQ(doubtful_graph(PoseGraph()).num_nodes(), 0U);
}

}  // namespace
}  // namespace psi_slam
