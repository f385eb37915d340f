// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/newest_covariance.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kMapNodes = 40;
constexpr double kStep_m = 0.5;

void link(std::size_t from, std::size_t to, Constraint::Kind kind, PoseGraph& graph) {
  Constraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.from_T_to = graph.pose(to) - graph.pose(from);
  constraint.information = Eigen::Vector3d(2500, 2500, 62500).asDiagonal();
  constraint.kind = kind;
  graph.add_constraint(constraint);
}

// Adds the next node of a straight drive. Two local maps that overlap hold each node.
void drive_on(PoseGraph& graph) {
  const std::size_t node = graph.add_node({static_cast<double>(graph.num_nodes()) * kStep_m, 0, 0});
  if (node == 0) return;
  const std::size_t newest_anchor = (node - 1) / (kMapNodes / 2) * (kMapNodes / 2);
  link(newest_anchor, node, Constraint::Kind::kLocalMap, graph);
  if (newest_anchor > 0) link(newest_anchor - kMapNodes / 2, node, Constraint::Kind::kLocalMap, graph);
}

TEST(NewestCovariance, grows_between_loops_and_is_rarely_computed) {
  constexpr std::size_t kNodes = 1000;
  PoseGraph graph;
  NewestCovariance newest;
  double earlier_m2 = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    drive_on(graph);
    const Eigen::Matrix3d covariance = newest.update(graph);
    if (i % 60 != 59) continue;
    EXPECT_GT(covariance.trace(), earlier_m2) << i;
    earlier_m2 = covariance.trace();
    const Eigen::Matrix3d expected = pose_covariance(graph, i);
    EXPECT_LT((covariance - expected).norm(), 0.1 * expected.norm()) << i;
  }
  EXPECT_LT(newest.computations(), kNodes / 4);

  // A loop counts after the graph has grown by 0.5 %.
  link(0, kNodes - 1, Constraint::Kind::kLoop, graph);
  for (std::size_t i = 0; i < kNodes / 100; ++i) drive_on(graph);
  EXPECT_LT(newest.update(graph).trace(), earlier_m2 / 4);
}

// Each of 60 nodes brings a loop, but the graph grows by 0.5 % only with every fourth node.
TEST(NewestCovariance, is_rarely_computed_if_each_node_has_a_loop) {
  constexpr std::size_t kNodes = 600;
  PoseGraph graph;
  for (std::size_t i = 0; i < kNodes; ++i) drive_on(graph);
  NewestCovariance newest;
  newest.update(graph);
  for (std::size_t i = 0; i < 60; ++i) {
    drive_on(graph);
    link(i, kNodes + i, Constraint::Kind::kLoop, graph);
    newest.update(graph);
  }
  EXPECT_LE(newest.computations(), 16U);
}

TEST(NewestCovariance, is_carried_along_by_the_motion) {
  PoseGraph graph;
  for (std::size_t i = 0; i < 200; ++i) drive_on(graph);
  NewestCovariance newest;
  const Eigen::Matrix3d before = newest.update(graph);
  drive_on(graph);
  const Eigen::Matrix3d after = newest.update(graph);
  ASSERT_EQ(newest.computations(), 1U);
  const auto drift = drift_covariance(graph, 200, mean_local_map(graph));
  ASSERT_TRUE(drift);
  EXPECT_NEAR(after(2, 2), before(2, 2) + (*drift)(2, 2), 1e-4 * after(2, 2));
  EXPECT_NEAR(after(1, 1) - (*drift)(1, 1),
              before(1, 1) + 2 * kStep_m * before(1, 2) + kStep_m * kStep_m * before(2, 2),
              1e-4 * after(1, 1));
}

TEST(NewestCovariance, is_zero_at_the_first_node) {
  PoseGraph graph;
  NewestCovariance newest;
  EXPECT_EQ(newest.update(graph).norm(), 0);
  drive_on(graph);
  EXPECT_EQ(newest.update(graph).norm(), 0);
  drive_on(graph);
  EXPECT_GT(newest.update(graph).trace(), 0);
}

}  // namespace
}  // namespace psi_slam
