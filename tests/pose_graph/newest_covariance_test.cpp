// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/newest_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "pose_graph/shared_errors.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kSegmentNodes = 6;
constexpr double kStep_m = 0.5;

Eigen::Matrix3d drift_of_step() {
  return Eigen::Vector3d(1e-4, 4e-4, 1.6e-5).asDiagonal();
}

void link(std::size_t from, std::size_t to, Constraint::Kind kind, PoseGraph& graph) {
  Constraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.from_T_to = graph.pose(to) - graph.pose(from);
  const double steps = kind == Constraint::Kind::kLocalMap ? static_cast<double>(to - from) : 1;
  constraint.information = (steps * drift_of_step()).inverse();
  constraint.kind = kind;
  graph.add_constraint(constraint);
}

// Adds the next node of a straight drive along the heading. It hangs on the first node of its segment, or of
// the segment before if it begins one.
void drive_on(PoseGraph& graph, double heading_rad = 0) {
  const double travelled_m = static_cast<double>(graph.num_nodes()) * kStep_m;
  const std::size_t node =
      graph.add_node({travelled_m * std::cos(heading_rad), travelled_m * std::sin(heading_rad), heading_rad});
  if (node > 0) link((node - 1) / kSegmentNodes * kSegmentNodes, node, Constraint::Kind::kLocalMap, graph);
}

PoseGraph drive(std::size_t nodes) {
  PoseGraph graph;
  for (std::size_t i = 0; i < nodes; ++i) drive_on(graph);
  return graph;
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
  PoseGraph graph = drive(kNodes);
  NewestCovariance newest;
  newest.update(graph);
  for (std::size_t i = 0; i < 60; ++i) {
    drive_on(graph);
    link(i, kNodes + i, Constraint::Kind::kLoop, graph);
    newest.update(graph);
  }
  EXPECT_LE(newest.computations(), 16U);
}

// Without loops, the covariance that is carried along is exact.
TEST(NewestCovariance, is_carried_along_the_segments) {
  PoseGraph graph;
  for (std::size_t i = 0; i < 1000; ++i) drive_on(graph, 0.7);
  NewestCovariance newest;
  newest.update(graph);
  for (std::size_t i = 0; i < 3 * kSegmentNodes; ++i) {
    drive_on(graph, 0.7);
    const Eigen::Matrix3d& covariance = newest.update(graph);
    const Eigen::Matrix3d expected = pose_covariance(graph, graph.num_nodes() - 1);
    EXPECT_TRUE(covariance.isApprox(expected, 1e-6)) << graph.num_nodes();
  }
  EXPECT_EQ(newest.computations(), 1U);
}

TEST(NewestCovariance, is_carried_over_several_nodes_at_once) {
  PoseGraph graph = drive(1000);
  NewestCovariance newest;
  newest.update(graph);
  for (std::size_t i = 0; i < 2 * kSegmentNodes + 1; ++i) drive_on(graph);
  EXPECT_TRUE(newest.update(graph).isApprox(pose_covariance(graph, graph.num_nodes() - 1), 1e-6));
  EXPECT_EQ(newest.computations(), 1U);
}

TEST(NewestCovariance, is_computed_again_where_the_path_is_interrupted) {
  PoseGraph graph = drive(1000);
  NewestCovariance newest;
  newest.update(graph);
  const std::size_t begin = graph.add_node({0, 5, 0});
  link(0, begin, Constraint::Kind::kRunStart, graph);
  EXPECT_TRUE(newest.update(graph).isApprox(pose_covariance(graph, begin), 1e-6));
  EXPECT_EQ(newest.computations(), 2U);
  EXPECT_EQ(newest.newest_drift(graph).norm(), 0) << "the newest node begins a run";
}

TEST(NewestCovariance, states_the_mean_drift_of_a_node_in_the_axes_of_the_map) {
  const NewestCovariance newest;
  for (const std::size_t nodes : {2 * kSegmentNodes + 1, 2 * kSegmentNodes + 4}) {
    PoseGraph graph;
    for (std::size_t i = 0; i < nodes; ++i) drive_on(graph, M_PI / 2);
    const Eigen::Matrix3d expected = Eigen::Vector3d(4e-4, 1e-4, 1.6e-5).asDiagonal();
    EXPECT_TRUE(newest.newest_drift(graph).isApprox(expected, 1e-6)) << nodes;
  }
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
