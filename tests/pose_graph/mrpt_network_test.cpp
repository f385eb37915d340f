// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/mrpt_network.h"

#include <gmock/gmock.h>

#include "psi_slam/user_error.h"
#include "test_graphs.h"

namespace psi_slam {
namespace {

TEST(MrptNetwork, converts_to_MRPT_and_back_with_its_enabled_constraints) {
  KnownGraph known = ring(20, 3, 1);
  known.graph.set_enabled(known.graph.num_constraints() - 1, false);
  known.graph.set_root(4);
  const mrpt::graphs::CNetworkOfPoses2DInf network = mrpt_network(known.graph);
  EXPECT_EQ(network.nodes.size(), 20U);
  EXPECT_EQ(network.edges.size(), known.graph.num_constraints() - 1);
  const PoseGraph back = pose_graph_of(network);
  EXPECT_EQ(back.root(), 4U);
  EXPECT_EQ(back.poses(), known.graph.poses());
  EXPECT_NEAR(back.chi2(), known.graph.chi2(), 1e-9 * known.graph.chi2());
  std::size_t loops = 0;
  for (const Constraint& constraint : back.constraints()) loops += constraint.kind == Constraint::Kind::kLoop;
  EXPECT_EQ(loops, 2U);
}

TEST(MrptNetwork, keeps_several_constraints_of_one_pair) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({1, 0, 0});
  Constraint constraint;
  constraint.from = 0;
  constraint.to = 1;
  constraint.from_T_to = {1, 0, 0};
  constraint.information = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) graph.add_constraint(constraint);
  EXPECT_EQ(pose_graph_of(mrpt_network(graph)).num_constraints(), 3U);
}

TEST(MrptNetwork, converts_an_empty_graph) {
  EXPECT_TRUE(mrpt_network(PoseGraph()).nodes.empty());
  EXPECT_EQ(pose_graph_of(mrpt::graphs::CNetworkOfPoses2DInf()).num_nodes(), 0U);
}

TEST(MrptNetwork, names_a_missing_node) {
  mrpt::graphs::CNetworkOfPoses2DInf network;
  network.nodes[0] = mrpt::poses::CPose2D();
  network.nodes[2] = mrpt::poses::CPose2D();
  try {
    pose_graph_of(network);
    FAIL() << "no exception";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no node 1"));
  }
}

}  // namespace
}  // namespace psi_slam
