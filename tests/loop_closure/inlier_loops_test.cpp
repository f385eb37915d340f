// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/outlier_loops.h"

#include <gtest/gtest.h>

#include <cmath>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr double kMaxChi = 5;

// A chain of ten nodes, one metre apart by its constraints, but at wrong poses. Each constraint has standard
// deviations of 0.1 m and 0.01 rad.
PoseGraph chain() {
  PoseGraph graph;
  for (std::size_t i = 0; i < 10; ++i) {
    graph.add_node({static_cast<double>(i) * static_cast<double>(i), 3, 1});
    if (i == 0) continue;
    Constraint step;
    step.from = i - 1;
    step.to = i;
    step.from_T_to = {1, 0, 0};
    step.information = Eigen::Vector3d(100, 100, 1e4).asDiagonal();
    step.kind = Constraint::Kind::kLocalMap;
    graph.add_constraint(step);
  }
  return graph;
}

std::size_t add_loop(PoseGraph& graph, std::size_t to, double off_x_m, double off_y_m = 0) {
  Constraint loop;
  loop.to = to;
  loop.from_T_to = {static_cast<double>(to) + off_x_m, off_y_m, 0};
  loop.information = Eigen::Vector3d(2500, 2500, 1e4).asDiagonal();
  loop.kind = Constraint::Kind::kLoop;
  return graph.add_constraint(loop);
}

TEST(InlierLoops, path_chi_adds_the_uncertainty_of_path_and_loop) {
  PoseGraph graph = chain();
  for (std::size_t i = 0; i < 10; ++i) graph.set_pose(i, {static_cast<double>(i), 0, 0});
  const std::vector<std::size_t> loops{add_loop(graph, 4, 0.5), add_loop(graph, 4, 0)};
  for (const std::size_t loop : loops) graph.set_enabled(loop, false);
  const std::vector<double> chi = path_chi(graph, loops);
  EXPECT_NEAR(chi[0], 0.5 / std::sqrt(4 * 0.01 + 0.0004), 1e-6);
  EXPECT_NEAR(chi[1], 0, 1e-9);
}

TEST(InlierLoops, finds_few_true_loops_among_many_false_ones) {
  PoseGraph graph = chain();
  std::vector<std::size_t> loops;
  for (const std::size_t to : {7U, 8U, 9U}) loops.push_back(add_loop(graph, to, 0.01));
  for (std::size_t i = 0; i < 15; ++i)
    loops.push_back(add_loop(graph, 3 + i % 7, 4 + 3 * static_cast<double>(i), -5));
  SparsePoseAdjustment solver;
  select_inlier_loops(graph, solver, loops, kMaxChi);
  for (std::size_t i = 0; i < loops.size(); ++i) EXPECT_EQ(graph.enabled(loops[i]), i < 3) << i;
  const mrpt::math::TPose2D far = graph.pose(9) - graph.pose(0);
  EXPECT_NEAR(far.x, 9.01, 0.01);
  EXPECT_NEAR(far.y, 0, 0.01);
}

TEST(InlierLoops, within_the_gate_the_majority_decides) {
  PoseGraph graph = chain();
  std::vector<std::size_t> loops;
  for (int i = 0; i < 5; ++i) loops.push_back(add_loop(graph, 9, 0.2, 0.1));
  for (int i = 0; i < 2; ++i) loops.push_back(add_loop(graph, 9, -0.8, 0.3 * i));
  SparsePoseAdjustment solver;
  select_inlier_loops(graph, solver, loops, kMaxChi);
  for (std::size_t i = 0; i < loops.size(); ++i) EXPECT_EQ(graph.enabled(loops[i]), i < 5) << i;
}

TEST(InlierLoops, ignores_previous_poses_and_enabled_loops) {
  PoseGraph graph = chain();
  std::vector<std::size_t> loops{add_loop(graph, 9, 0.02), add_loop(graph, 8, 30), add_loop(graph, 7, 0)};
  PoseGraph other = graph;
  other.set_enabled(loops[0], false);
  for (std::size_t i = 1; i < 10; ++i) other.set_pose(i, {0, static_cast<double>(i), 2});
  other.set_pose(0, graph.pose(0));
  SparsePoseAdjustment solver;
  SparsePoseAdjustment other_solver;
  select_inlier_loops(graph, solver, loops, kMaxChi);
  select_inlier_loops(other, other_solver, loops, kMaxChi);
  for (const std::size_t loop : loops) EXPECT_EQ(graph.enabled(loop), other.enabled(loop));
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(graph.pose(i), other.pose(i));
}

TEST(InlierLoops, refuses_a_node_connected_by_loops_only) {
  PoseGraph graph = chain();
  graph.add_node({5, 5, 0});
  const std::vector<std::size_t> loops{add_loop(graph, 10, 0)};
  SparsePoseAdjustment solver;
  EXPECT_THROW(select_inlier_loops(graph, solver, loops, kMaxChi), UserError);
}

TEST(InlierLoops, many_contradictions_lead_to_the_selection_of_inliers) {
  PoseGraph graph = chain();
  std::vector<std::size_t> loops;
  for (const std::size_t to : {7U, 8U, 9U}) loops.push_back(add_loop(graph, to, 0.01));
  for (std::size_t i = 0; i < 30; ++i)  // five groups of false loops, each consistent in itself
    loops.push_back(add_loop(graph, 3 + i % 6, 6 + 4 * static_cast<double>(i / 6), -8));
  SparsePoseAdjustment solver;
  const std::vector<double> chi = switch_off_outlier_loops(graph, solver, loops, kMaxChi);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_EQ(graph.enabled(loops[i]), i < 3) << i;
    EXPECT_EQ(chi[i] <= kMaxChi, i < 3) << i;
  }
}

}  // namespace
}  // namespace psi_slam
