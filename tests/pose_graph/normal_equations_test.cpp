// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/normal_equations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dense_reference.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

struct Linearization {
  std::vector<RotatedPose> poses;
  std::vector<Eigen::Vector3d> errors;
  std::vector<double> weights;
};

Linearization at_current_poses(const PoseGraph& graph) {
  Linearization result;
  for (const TPose2D& pose : graph.poses()) result.poses.emplace_back(pose);
  for (const Constraint& constraint : graph.constraints())
    result.errors.push_back(
        constraint_error(constraint.from_T_to, result.poses[constraint.from], result.poses[constraint.to]));
  result.weights.assign(graph.num_constraints(), 1);
  return result;
}

// Returns the step of the equations in the order of the nodes, without the root, which must be node 0.
Eigen::VectorXd step_by_node(NormalEquations& equations, const PoseGraph& graph, double lambda = 0) {
  equations.prepare(graph);
  const Linearization at = at_current_poses(graph);
  equations.linearize(graph, at.poses, at.errors, at.weights);
  EXPECT_TRUE(equations.factorize(lambda));
  const Eigen::VectorXd step = equations.step();
  Eigen::VectorXd result(step.size());
  for (std::size_t node = 1; node < graph.num_nodes(); ++node)
    result.segment<3>(3 * static_cast<Eigen::Index>(node) - 3) =
        step.segment<3>(3 * static_cast<Eigen::Index>(equations.variable_of(node)));
  return result;
}

Eigen::VectorXd reference_step(const PoseGraph& graph, double lambda = 0) {
  const DenseSystem system = held_at_root(dense_system(graph));
  const Eigen::MatrixXd damped = system.h + lambda * Eigen::MatrixXd(system.h.diagonal().asDiagonal());
  return damped.ldlt().solve(-system.g);
}

TEST(NormalEquations, give_the_step_of_the_dense_system) {
  const KnownGraph known = building(150, 2, 2);
  NormalEquations equations;
  for (const double lambda : {0.0, 0.1, 10.0}) {
    const Eigen::VectorXd expected = reference_step(known.graph, lambda);
    EXPECT_LT((step_by_node(equations, known.graph, lambda) - expected).norm(), 1e-5 * expected.norm());
  }
}

TEST(NormalEquations, predict_the_decrease_of_the_error) {
  const KnownGraph known = building(100, 2, 2);
  NormalEquations equations;
  for (const double lambda : {0.0, 0.3}) {
    step_by_node(equations, known.graph, lambda);
    const DenseSystem system = held_at_root(dense_system(known.graph));
    const Eigen::VectorXd dx = reference_step(known.graph, lambda);
    const double expected = -2 * system.g.dot(dx) - dx.dot(system.h * dx);
    EXPECT_NEAR(equations.predicted_decrease(equations.step(), lambda), expected, 1e-5 * expected);
  }
}

TEST(NormalEquations, compute_the_gradient) {
  const KnownGraph known = building(100, 2, 2);
  NormalEquations equations;
  step_by_node(equations, known.graph);
  const double expected = 2 * held_at_root(dense_system(known.graph)).g.cwiseAbs().maxCoeff();
  EXPECT_NEAR(equations.max_gradient(), expected, 1e-5 * expected);
}

TEST(NormalEquations, hold_headings_or_positions) {
  const KnownGraph known = building(80, 2, 2);
  const Linearization at = at_current_poses(known.graph);
  NormalEquations equations;
  equations.prepare(known.graph);
  using Coordinates = NormalEquations::Coordinates;

  equations.linearize(known.graph, at.poses, at.errors, at.weights, Coordinates::kPositions);
  ASSERT_TRUE(equations.factorize(0));
  Eigen::VectorXd step = equations.step();
  double moved = 0;
  for (Eigen::Index k = 0; k < step.size(); ++k) {
    EXPECT_TRUE(k % 3 != 2 || step[k] == 0);
    moved += std::abs(step[k]);
  }
  EXPECT_GT(moved, 0);
  // The problem is linear in the positions, so a second step is zero.
  PoseGraph graph = known.graph;
  for (std::size_t node = 1; node < graph.num_nodes(); ++node) {
    const auto delta = step.segment<3>(3 * static_cast<Eigen::Index>(equations.variable_of(node)));
    const TPose2D& pose = graph.pose(node);
    graph.set_pose(node, {pose.x + delta.x(), pose.y + delta.y(), pose.phi});
  }
  const Linearization after = at_current_poses(graph);
  equations.linearize(graph, after.poses, after.errors, after.weights, Coordinates::kPositions);
  ASSERT_TRUE(equations.factorize(0));
  EXPECT_LT(equations.step().norm(), 1e-9 * step.norm());

  equations.linearize(known.graph, at.poses, at.errors, at.weights, Coordinates::kHeadings);
  ASSERT_TRUE(equations.factorize(0));
  step = equations.step();
  for (Eigen::Index k = 0; k < step.size(); ++k) EXPECT_TRUE(k % 3 == 2 || step[k] == 0);
}

TEST(NormalEquations, follow_a_graph_that_grows) {
  const KnownGraph known = building(300, 2, 2);
  NormalEquations kept;
  PoseGraph graph;
  graph.add_node(known.graph.pose(0));
  std::size_t next = 0;
  int reordered = 0;
  int reused = 0;
  for (std::size_t node = 1; node < known.graph.num_nodes(); ++node) {
    graph.add_node(known.graph.pose(node));
    const std::vector<Constraint>& all = known.graph.constraints();
    for (; next < all.size() && std::max(all[next].from, all[next].to) == node; ++next)
      graph.add_constraint(all[next]);
    if (node % 7 != 0) continue;
    const Eigen::VectorXd step = step_by_node(kept, graph);
    EXPECT_TRUE(kept.restructured());
    reordered += kept.reordered() ? 1 : 0;
    NormalEquations fresh;
    const Eigen::VectorXd expected = step_by_node(fresh, graph);
    EXPECT_LT((step - expected).norm(), 1e-8 * (1e-3 + expected.norm()));
    kept.prepare(graph);
    reused += kept.restructured() ? 0 : 1;
  }
  EXPECT_EQ(reused, 42) << "an unchanged graph keeps its layout";
  EXPECT_GT(reordered, 0);
  EXPECT_LT(reordered, 30) << "the order of elimination is usually extended";
}

TEST(NormalEquations, accept_constraints_that_are_switched_off_and_on) {
  KnownGraph known = building(400, 2, 3);
  PoseGraph& graph = known.graph;
  std::vector<std::size_t> loops;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i)
    if (graph.constraint(i).kind == Constraint::Kind::kLoop) loops.push_back(i);
  ASSERT_FALSE(loops.empty());
  NormalEquations equations;
  for (const std::size_t loop : loops) graph.set_enabled(loop, false);
  EXPECT_LT((step_by_node(equations, graph) - reference_step(graph)).norm(), 1e-5);
  for (const std::size_t loop : loops) graph.set_enabled(loop, true);
  EXPECT_LT((step_by_node(equations, graph) - reference_step(graph)).norm(), 1e-5);
  EXPECT_TRUE(equations.restructured()) << "the blocks of the loops are new";
  graph.set_enabled(loops.front(), false);
  EXPECT_LT((step_by_node(equations, graph) - reference_step(graph)).norm(), 1e-5);
  EXPECT_FALSE(equations.restructured()) << "the block of a disabled loop stays, filled with zeros";
}

// The graph changes as after the final loop search: no new nodes, but many new loops, some of which are
// switched off later.
TEST(NormalEquations, many_new_loops_cause_a_new_order_at_once) {
  PoseGraph graph = building(1500, 2, 3).graph;
  const std::size_t nodes = graph.num_nodes();
  NormalEquations kept;
  kept.prepare(graph);
  Constraint constraint;
  for (std::size_t i = 0; i < 3 * nodes; ++i) {
    constraint.from = i % nodes;
    constraint.to = (constraint.from + 600 + 7 * (i / nodes)) % nodes;
    constraint.from_T_to = relative_pose(graph.pose(constraint.from), graph.pose(constraint.to));
    graph.add_constraint(constraint);
  }
  kept.prepare(graph);
  NormalEquations fresh;
  fresh.prepare(graph);
  EXPECT_TRUE(kept.reordered());
  EXPECT_EQ(kept.factor().num_products(), fresh.factor().num_products());
  EXPECT_LT((step_by_node(kept, graph) - step_by_node(fresh, graph)).norm(), 1e-9);
}

TEST(NormalEquations, accept_another_graph) {
  const KnownGraph first = building(120, 2, 2, 1);
  const KnownGraph second = ring(60, 2, 1);
  NormalEquations equations;
  step_by_node(equations, first.graph);
  EXPECT_LT((step_by_node(equations, second.graph) - reference_step(second.graph)).norm(), 1e-4);
  EXPECT_LT((step_by_node(equations, first.graph) - reference_step(first.graph)).norm(), 1e-4);
  PoseGraph other_root = first.graph;
  other_root.set_root(7);
  equations.prepare(other_root);
  EXPECT_EQ(equations.variable_of(7), NormalEquations::kHeld);
  EXPECT_NE(equations.variable_of(0), NormalEquations::kHeld);
}

TEST(NormalEquations, name_a_node_that_only_a_disabled_constraint_links) {
  KnownGraph known = ring(10, 0, 0);
  known.graph.set_enabled(5, false);  // the constraint from node 5 to node 6
  NormalEquations equations;
  try {
    equations.prepare(known.graph);
    FAIL() << "no exception";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("node 6 of the pose graph is not linked to node 0"));
  }
  known.graph.set_enabled(5, true);
  EXPECT_NO_THROW(equations.prepare(known.graph)) << "no error once the node is linked again";
}

}  // namespace
}  // namespace psi_slam
