// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/graph_mirror.h"

#include <gtest/gtest.h>

#include <limits>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPose2D;

Constraint link(std::size_t from, std::size_t to, double x) {
  Constraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.from_T_to = {x, 0, 0};
  return constraint;
}

MrptGraph::edge_t edge(double x, double information = 1) {
  mrpt::math::CMatrixDouble33 matrix = mrpt::math::CMatrixDouble33::Zero();
  matrix.setDiagonal(3, information);
  return {CPose2D(x, 0, 0), matrix};
}

/// A graph of two nodes and one edge that psi-slam has published to MRPT's network.
struct Shared {
  GraphMirror mirror;
  MrptGraph network;
  Shared() {
    mirror.graph().add_node({0, 0, 0});
    mirror.graph().add_node({1, 0, 0});
    mirror.graph().add_constraint(link(0, 1, 1));
    mirror.publish(network);
  }
};

TEST(GraphMirror, publishes_additions_once) {
  Shared shared;
  shared.mirror.publish(shared.network);
  shared.mirror.read(shared.network);
  EXPECT_EQ(shared.network.nodes.size(), 2U);
  EXPECT_EQ(shared.network.edges.size(), 1U);
  EXPECT_EQ(shared.mirror.graph().num_nodes(), 2U);
  EXPECT_EQ(shared.mirror.graph().num_constraints(), 1U);
}

TEST(GraphMirror, reads_edges_of_others_once_even_parallel_ones) {
  Shared shared;
  shared.network.insertEdgeAtEnd(0, 1, edge(1.5));
  shared.mirror.read(shared.network);
  shared.mirror.read(shared.network);
  ASSERT_EQ(shared.mirror.graph().num_constraints(), 2U);
  EXPECT_EQ(shared.mirror.graph().constraint(1).from_T_to.x, 1.5);
}

TEST(GraphMirror, a_new_node_of_others_follows_from_its_edge) {
  Shared shared;
  shared.mirror.graph().set_pose(1, {1, 5, 0});  // as after an optimisation
  shared.network.nodes[2] = CPose2D(7, 7, 7);    // as after a reset by the engine
  shared.network.insertEdgeAtEnd(1, 2, edge(2));
  shared.mirror.read(shared.network);
  ASSERT_EQ(shared.mirror.graph().num_nodes(), 3U);
  EXPECT_EQ(shared.mirror.graph().pose(2).x, 3);
  EXPECT_EQ(shared.mirror.graph().pose(2).y, 5);
}

TEST(GraphMirror, the_root_is_at_the_origin) {
  GraphMirror mirror;
  MrptGraph network;
  network.root = 0;
  network.nodes[0] = CPose2D(0.5, 0, 0);  // as MRPT's node deciders register it
  network.nodes[1] = CPose2D(1, 0, 0);
  network.insertEdgeAtEnd(0, 1, edge(0.5));
  mirror.read(network);
  EXPECT_EQ(mirror.graph().pose(0).x, 0);
  EXPECT_EQ(mirror.graph().pose(1).x, 0.5);
}

TEST(GraphMirror, copies_poses_both_ways) {
  Shared shared;
  shared.network.nodes[1] = CPose2D(3, 2, 1);
  shared.mirror.read_poses(shared.network);
  EXPECT_EQ(shared.mirror.graph().pose(1).y, 2);
  shared.mirror.graph().set_pose(1, {4, 0, 0});
  shared.mirror.write_poses(shared.network);
  EXPECT_EQ(shared.network.nodes.at(1).x(), 4);
}

TEST(GraphMirror, removes_only_disabled_edges) {
  Shared shared;
  const std::size_t off = shared.mirror.graph().add_constraint(link(0, 1, 9));
  shared.mirror.graph().add_constraint(link(0, 1, 1.1));
  shared.mirror.publish(shared.network);
  shared.mirror.graph().set_enabled(off, false);
  shared.mirror.remove_disabled(shared.network);
  ASSERT_EQ(shared.network.edges.size(), 2U);
  for (const auto& one : shared.network.edges) EXPECT_LT(one.second.getPoseMean().x(), 2);
}

TEST(GraphMirror, an_edge_with_invalid_information_gets_a_large_uncertainty) {
  Shared shared;
  shared.network.insertEdgeAtEnd(0, 1, edge(1, std::numeric_limits<double>::quiet_NaN()));
  shared.mirror.read(shared.network);
  EXPECT_EQ(shared.mirror.graph().constraint(1).information, Eigen::Matrix3d::Identity());
}

TEST(GraphMirror, nodes_must_be_numbered_without_a_gap) {
  Shared shared;
  shared.network.nodes[5] = CPose2D(0, 0, 0);
  EXPECT_THROW(shared.mirror.read(shared.network), UserError);
}

}  // namespace
}  // namespace psi_slam
