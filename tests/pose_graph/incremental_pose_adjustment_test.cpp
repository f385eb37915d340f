// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/incremental_pose_adjustment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "psi_slam/user_error.h"
#include "test_graphs.h"

namespace psi_slam {
namespace {

using Kind = Constraint::Kind;

/// Returns the graph of building() whose nodes hang on the anchors of local maps only, as in a map.
PoseGraph hung_on_anchors(std::size_t nodes, std::uint64_t seed, double noise = 1) {
  const KnownGraph known = building(nodes, 2, 3, seed, noise);
  PoseGraph graph;
  for (const TPose2D& pose : known.graph.poses()) graph.add_node(pose);
  for (const Constraint& constraint : known.graph.constraints())
    if (constraint.kind != Kind::kOdometry || constraint.to == 1) graph.add_constraint(constraint);
  return graph;
}

/// Builds `whole` up node by node in a new graph. A new node is placed by its first constraint. Calls `grown`
/// after each node with all its constraints.
PoseGraph grow(const PoseGraph& whole, const std::function<void(PoseGraph&)>& grown) {
  PoseGraph graph;
  graph.add_node(whole.pose(0));
  for (const Constraint& constraint : whole.constraints()) {
    const std::size_t newest = std::max(constraint.from, constraint.to);
    if (newest == graph.num_nodes()) {
      grown(graph);
      graph.add_node(compose(graph.pose(constraint.from), constraint.from_T_to));
    }
    graph.add_constraint(constraint);
  }
  grown(graph);
  return graph;
}

double max_distance_m(const PoseGraph& a, const PoseGraph& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.num_nodes(); ++i)
    largest = std::max(largest, std::hypot(a.pose(i).x - b.pose(i).x, a.pose(i).y - b.pose(i).y));
  return largest;
}

bool same_poses(const PoseGraph& a, const PoseGraph& b) {
  return a.num_nodes() == b.num_nodes() &&
         std::memcmp(a.poses().data(), b.poses().data(), a.num_nodes() * sizeof(TPose2D)) == 0;
}

PoseAdjustmentOptions thorough(PoseAdjustmentOptions options = {}) {
  options.max_iterations = 200;
  options.relative_tolerance = 1e-11;
  return options;
}

/// Compares each solution of a growing graph with the optimum of the whole graph.
struct Comparison {
  explicit Comparison(PoseAdjustmentOptions options = {}) : solver(options), reference(thorough(options)) {}

  void optimize(PoseGraph& graph) {
    PoseGraph optimum = graph;
    const PoseAdjustmentReport best = reference.optimize(optimum);
    const IncrementalReport report = adjustment.optimize(graph, solver);
    // The error sum at the poses of the graph, without a step.
    PoseAdjustmentOptions no_step = solver.options();
    no_step.max_iterations = 0;
    PoseGraph copy = graph;
    const double chi2 = SparsePoseAdjustment(no_step).optimize(copy).final_robust_chi2;
    EXPECT_NEAR(report.robust_chi2, chi2, 5e-3 * (1 + chi2));
    const double excess = (chi2 - best.final_robust_chi2) / (1 + best.final_robust_chi2);
    const double distance_m = max_distance_m(graph, optimum);
    double& worst_excess = report.complete ? complete_excess : incremental_excess;
    double& worst_distance_m = report.complete ? complete_distance_m : incremental_distance_m;
    worst_excess = std::max(worst_excess, excess);
    worst_distance_m = std::max(worst_distance_m, distance_m);
    ++(report.complete ? complete : incremental);
  }

  IncrementalPoseAdjustment adjustment;
  SparsePoseAdjustment solver;
  SparsePoseAdjustment reference;
  int complete = 0;
  int incremental = 0;
  double complete_excess = 0;  // of the error sum, as a share
  double incremental_excess = 0;
  double complete_distance_m = 0;
  double incremental_distance_m = 0;
};

TEST(IncrementalPoseAdjustment, stays_close_to_the_optimum_of_a_growing_graph) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const PoseGraph& whole : {hung_on_anchors(500, seed), building(300, 2, 2, seed).graph}) {
      Comparison comparison;
      grow(whole, [&](PoseGraph& graph) {
        if (graph.num_nodes() % 6 == 0) comparison.optimize(graph);
      });
      EXPECT_GT(comparison.incremental, comparison.complete);
      EXPECT_LT(comparison.complete_excess, 1e-3);
      EXPECT_LT(comparison.complete_distance_m, 1e-3);
      EXPECT_LT(comparison.incremental_excess, 1e-3);
      EXPECT_LT(comparison.incremental_distance_m, 5e-3);
    }
  }
}

TEST(IncrementalPoseAdjustment, stays_close_to_the_optimum_with_false_loops_and_kernels) {
  using Type = RobustKernel::Type;
  for (const Type type : {Type::kHuber, Type::kCauchy}) {
    PoseAdjustmentOptions options;
    options.loop_kernel = {type, 2};
    options.local_map_kernel = {Type::kHuber, 3};
    Comparison comparison(options);
    const PoseGraph whole = hung_on_anchors(400, 7);
    Measurer measurer(7);
    std::size_t false_loops = 0;
    grow(whole, [&](PoseGraph& graph) {
      const std::size_t newest = graph.num_nodes() - 1;
      if (newest % 50 == 45) {
        Constraint loop = whole.constraints().back();
        loop.kind = Kind::kLoop;
        loop.from = newest / 80 * 40;
        loop.to = newest;
        loop.from_T_to = relative_pose(graph.pose(loop.from), graph.pose(loop.to));
        loop.from_T_to.x += 0.3 * measurer.normal();
        graph.add_constraint(loop);
        ++false_loops;
      }
      if (newest % 5 == 0) comparison.optimize(graph);
    });
    EXPECT_GT(false_loops, 5U);
    EXPECT_GT(comparison.incremental, comparison.complete);
    EXPECT_LT(comparison.complete_distance_m, 1e-3);
    EXPECT_LT(comparison.incremental_excess, 1e-3);
    EXPECT_LT(comparison.incremental_distance_m, 2e-2);
  }
}

TEST(IncrementalPoseAdjustment, does_work_in_proportion_to_the_news) {
  std::size_t core_nodes = 0;
  for (const std::size_t nodes : {1000U, 4000U}) {
    PoseGraph graph = hung_on_anchors(nodes, 3);
    IncrementalPoseAdjustment adjustment;
    SparsePoseAdjustment solver;
    ASSERT_TRUE(adjustment.optimize(graph, solver).complete);
    // The second constraint between two nodes that agrees with the first to a centimetre.
    Constraint news = graph.constraints().back();
    const TPose2D there = relative_pose(graph.pose(news.from), graph.pose(news.to));
    news.from_T_to = compose(there, {0.01, -0.01, 0.002});
    graph.add_constraint(news);
    const IncrementalReport report = adjustment.optimize(graph, solver);
    EXPECT_FALSE(report.complete);
    EXPECT_LE(report.linearized_nodes, 10U);
    EXPECT_LE(report.placed_nodes, 200U) << "only the nodes of the local maps nearby";
    EXPECT_GT(report.core_nodes, core_nodes) << "one for each local map";
    EXPECT_LE(report.core_nodes, nodes / 35);
    core_nodes = report.core_nodes;
  }
}

TEST(IncrementalPoseAdjustment, does_nothing_without_news) {
  PoseGraph graph = hung_on_anchors(300, 4);
  IncrementalPoseAdjustment adjustment;
  SparsePoseAdjustment solver;
  const double chi2 = adjustment.optimize(graph, solver).robust_chi2;
  const PoseGraph before = graph;
  const IncrementalReport report = adjustment.optimize(graph, solver);
  EXPECT_FALSE(report.complete);
  EXPECT_EQ(report.linearized_nodes, 0U);
  EXPECT_NEAR(report.robust_chi2, chi2, 1e-9 * chi2);
  EXPECT_TRUE(same_poses(graph, before));
}

TEST(IncrementalPoseAdjustment, gives_the_same_bytes_every_time) {
  const PoseGraph whole = hung_on_anchors(400, 5);
  const auto mapped = [&] {
    IncrementalPoseAdjustment adjustment;
    SparsePoseAdjustment solver;
    return grow(whole, [&](PoseGraph& graph) {
      if (graph.num_nodes() % 3 == 0) adjustment.optimize(graph, solver);
    });
  };
  EXPECT_TRUE(same_poses(mapped(), mapped()));
}

TEST(IncrementalPoseAdjustment, closes_a_ring) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const PoseGraph whole = ring(400, 3, 1, 0.02, 0.005, seed).graph;
    Comparison comparison;
    PoseGraph graph = grow(whole, [](PoseGraph&) {});
    PoseGraph open;
    for (const TPose2D& pose : graph.poses()) open.add_node(pose);
    for (const Constraint& constraint : whole.constraints())
      if (constraint.kind != Kind::kLoop) open.add_constraint(constraint);
    comparison.optimize(open);
    for (const Constraint& constraint : whole.constraints()) {
      if (constraint.kind != Kind::kLoop) continue;
      open.add_constraint(constraint);
      comparison.optimize(open);
    }
    EXPECT_LT(comparison.complete_distance_m, 1e-3);
    EXPECT_LT(comparison.incremental_distance_m, 2e-2);
    EXPECT_LT(comparison.incremental_excess, 1e-3);
  }
}

TEST(IncrementalPoseAdjustment, joins_a_second_run) {
  // The second run begins far from its place, by a constraint that hardly holds it.
  const PoseGraph first = hung_on_anchors(300, 6);
  Comparison comparison;
  PoseGraph graph = grow(first, [](PoseGraph&) {});
  comparison.optimize(graph);
  const TPose2D start(5, 4, 1);
  Constraint weak;
  weak.kind = Kind::kRunStart;
  weak.from = 299;
  weak.to = 300;
  weak.from_T_to = relative_pose(graph.pose(299), start);
  weak.information = Eigen::Vector3d(1e-6, 1e-6, 1e-3).asDiagonal();
  graph.add_node(start);
  graph.add_constraint(weak);
  for (std::size_t i = 1; i < 20; ++i) {
    Constraint constraint = first.constraint(1);
    constraint.from = 300;
    constraint.to = 300 + i;
    constraint.from_T_to = {0.5 * static_cast<double>(i), 0, 0};
    graph.add_node(compose(start, constraint.from_T_to));
    graph.add_constraint(constraint);
    comparison.optimize(graph);
  }
  Constraint loop = first.constraint(1);
  loop.kind = Kind::kLoop;
  loop.from = 40;
  for (loop.to = 310; loop.to < 313; ++loop.to) {
    loop.from_T_to = {1 + 0.5 * static_cast<double>(loop.to - 310), 2, 0};
    graph.add_constraint(loop);
  }
  comparison.optimize(graph);
  EXPECT_GT(comparison.incremental, 15);
  EXPECT_LT(comparison.complete_distance_m, 1e-3);
  EXPECT_LT(comparison.incremental_distance_m, 5e-3);
}

TEST(IncrementalPoseAdjustment, solves_completely_after_other_changes) {
  PoseGraph graph = hung_on_anchors(300, 8);
  IncrementalPoseAdjustment adjustment;
  SparsePoseAdjustment solver;
  const auto is_complete = [&] {
    PoseGraph copy = graph;
    const bool complete = adjustment.optimize(graph, solver).complete;
    SparsePoseAdjustment().optimize(copy);
    EXPECT_LT(max_distance_m(graph, copy), 1e-6);
    return complete;
  };
  EXPECT_TRUE(is_complete());
  EXPECT_FALSE(is_complete());
  const std::size_t loop = graph.num_constraints() - 1;
  graph.set_enabled(loop, false);
  EXPECT_TRUE(is_complete());
  EXPECT_FALSE(is_complete());
  graph.set_enabled(loop, true);
  EXPECT_TRUE(is_complete());
  graph.set_root(7);
  EXPECT_TRUE(is_complete());
  EXPECT_FALSE(is_complete());
  graph.set_pose(20, compose(graph.pose(20), {0.1, 0, 0}));
  EXPECT_TRUE(is_complete());
  graph = hung_on_anchors(299, 9);
  EXPECT_TRUE(is_complete());
}

TEST(IncrementalPoseAdjustment, continues_with_a_constraint_that_was_added_switched_off) {
  PoseGraph graph = hung_on_anchors(300, 10);
  IncrementalPoseAdjustment adjustment;
  SparsePoseAdjustment solver;
  adjustment.optimize(graph, solver);
  const PoseGraph before = graph;
  Constraint loop = graph.constraints().back();
  loop.from_T_to.x += 1;
  graph.set_enabled(graph.add_constraint(loop), false);
  EXPECT_FALSE(adjustment.optimize(graph, solver).complete);
  EXPECT_TRUE(same_poses(graph, before));
}

TEST(IncrementalPoseAdjustment, names_a_node_without_a_link_to_the_root) {
  PoseGraph graph = hung_on_anchors(100, 11);
  IncrementalPoseAdjustment adjustment;
  SparsePoseAdjustment solver;
  adjustment.optimize(graph, solver);
  const std::size_t lost = graph.add_node({1, 1, 0});
  graph.add_node({2, 1, 0});
  Constraint link = graph.constraint(0);
  link.from = lost;
  link.to = lost + 1;
  graph.add_constraint(link);
  const std::vector<TPose2D> before = graph.poses();
  try {
    adjustment.optimize(graph, solver);
    FAIL() << "no exception";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("node " + std::to_string(lost) + " "));
  }
  EXPECT_EQ(graph.poses(), before);
  link.from = 80;
  link.to = lost;
  graph.add_constraint(link);
  EXPECT_NO_THROW(adjustment.optimize(graph, solver));
}

TEST(IncrementalPoseAdjustment, leaves_undetermined_directions_to_the_complete_solution) {
  PoseGraph graph = hung_on_anchors(100, 12);
  Constraint constraint = graph.constraint(1);
  constraint.from = 40;
  constraint.to = graph.add_node(graph.pose(99));
  constraint.information(2, 2) = 0;
  graph.add_constraint(constraint);
  IncrementalPoseAdjustment adjustment;
  SparsePoseAdjustment solver;
  EXPECT_TRUE(adjustment.optimize(graph, solver).complete);
  EXPECT_TRUE(adjustment.optimize(graph, solver).complete);
}

TEST(IncrementalPoseAdjustment, accepts_empty_and_single_node_graphs) {
  PoseGraph graph;
  IncrementalPoseAdjustment adjustment;
  SparsePoseAdjustment solver;
  EXPECT_TRUE(adjustment.optimize(graph, solver).complete);
  graph.add_node({1, 2, 3});
  EXPECT_TRUE(adjustment.optimize(graph, solver).complete);
  EXPECT_FALSE(adjustment.optimize(graph, solver).complete);
  EXPECT_EQ(graph.pose(0), TPose2D(1, 2, 3));
}

}  // namespace
}  // namespace psi_slam
