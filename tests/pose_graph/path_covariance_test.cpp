// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/path_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "dense_reference.h"
#include "pose_graph/marginal_covariance.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {
namespace {

std::vector<RelativeUncertainty> path_covariances(const PoseGraph& graph, std::size_t source,
                                                  const PathCovarianceOptions& options = {}) {
  PathCovarianceSearch search;
  search.run(graph, source, options);
  std::vector<RelativeUncertainty> all;
  all.reserve(graph.num_nodes());
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) all.push_back(search.of(node));
  return all;
}

// Returns the covariance of the end of a chain, by first-order propagation through the composition of its
// links with numeric derivatives. Each link is the relative pose of two nodes of the graph.
Eigen::Matrix3d propagated(const PoseGraph& graph, const std::vector<std::size_t>& nodes,
                           const std::vector<std::size_t>& constraints) {
  const auto end_of_chain = [&](std::size_t disturbed, const Eigen::Vector3d& by) {
    TPose2D pose;
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      const Constraint& constraint = graph.constraint(constraints[k]);
      TPose2D link = relative_pose(graph.pose(constraint.from), graph.pose(constraint.to));
      if (k == disturbed) link = {link.x + by.x(), link.y + by.y(), link.phi + by.z()};
      if (constraint.from != nodes[k]) link = relative_pose(link, TPose2D());
      pose = compose(pose, link);
    }
    return pose;
  };
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    Eigen::Matrix3d jacobian;
    for (int c = 0; c < 3; ++c) {
      constexpr double kStep = 1e-6;
      const TPose2D plus = end_of_chain(k, kStep * Eigen::Vector3d::Unit(c));
      const TPose2D minus = end_of_chain(k, -kStep * Eigen::Vector3d::Unit(c));
      jacobian.col(c) =
          Eigen::Vector3d(plus.x - minus.x, plus.y - minus.y, wrap_to_pi(plus.phi - minus.phi)) / (2 * kStep);
    }
    const Eigen::Matrix3d covariance = graph.constraint(constraints[k]).information.inverse();
    sum += jacobian * covariance * jacobian.transpose();
  }
  return sum;
}

// Fills `constraints` with the chain from `source` to `node`, and `nodes` with the node at which each
// constraint starts.
void trace_back(const std::vector<RelativeUncertainty>& all, std::size_t source, std::size_t node,
                std::vector<std::size_t>& nodes, std::vector<std::size_t>& constraints) {
  for (; node != source; node = all[node].previous) {
    nodes.push_back(all[node].previous);
    constraints.push_back(all[node].constraint);
  }
  std::reverse(nodes.begin(), nodes.end());
  std::reverse(constraints.begin(), constraints.end());
}

PoseGraph with_skewed_information(const PoseGraph& graph) {
  PoseGraph result;
  for (const TPose2D& pose : graph.poses()) result.add_node(pose);
  Measurer measurer(9);
  for (Constraint constraint : graph.constraints()) {
    Eigen::Matrix3d root = Eigen::Matrix3d::Identity();
    for (int k = 0; k < 9; ++k) root(k / 3, k % 3) += 0.3 * measurer.normal();
    const Eigen::Matrix3d skewed = root * constraint.information * root.transpose();
    constraint.information = 0.5 * (skewed + skewed.transpose());
    result.add_constraint(constraint);
  }
  return result;
}

// Returns the cost of the chain to each node, or -1 if there is none. Searches greedily without a queue, and
// computes each cost by its definition.
std::vector<double> slow_costs(const PoseGraph& graph, std::size_t source, double lever) {
  struct State {
    std::vector<std::size_t> nodes, constraints;
    double cost = 0;
  };
  std::vector<State> settled(graph.num_nodes());
  std::vector<char> is_settled(graph.num_nodes(), 0);
  std::vector<double> costs(graph.num_nodes(), -1);
  is_settled[source] = 1;
  costs[source] = 0;
  while (true) {
    State best;
    std::size_t best_node = graph.num_nodes();
    for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
      const Constraint& constraint = graph.constraint(i);
      if (!graph.enabled(i) || is_settled[constraint.from] == is_settled[constraint.to]) continue;
      const bool forwards = is_settled[constraint.from] != 0;
      const std::size_t here = forwards ? constraint.from : constraint.to;
      const std::size_t there = forwards ? constraint.to : constraint.from;
      State next = settled[here];
      next.nodes.push_back(here);
      next.constraints.push_back(i);
      const Eigen::Matrix3d covariance = propagated(graph, next.nodes, next.constraints);
      next.cost = covariance(0, 0) + covariance(1, 1) + lever * lever * covariance(2, 2);
      if (best_node != graph.num_nodes() && next.cost >= best.cost) continue;
      best = next;
      best_node = there;
    }
    if (best_node == graph.num_nodes()) return costs;
    settled[best_node] = best;
    is_settled[best_node] = 1;
    costs[best_node] = best.cost;
  }
}

TEST(PathCovariance, is_the_propagation_along_its_chain) {
  const KnownGraph known = building(200, 2, 2);
  const PoseGraph graph = with_skewed_information(known.graph);
  for (const std::size_t source : {0, 57, 199}) {
    const std::vector<RelativeUncertainty> all = path_covariances(graph, source);
    EXPECT_EQ(all[source].covariance, Eigen::Matrix3d::Zero());
    EXPECT_EQ(all[source].previous, source);
    for (std::size_t node = 0; node < graph.num_nodes(); node += 13) {
      ASSERT_TRUE(all[node].reached);
      std::vector<std::size_t> nodes;
      std::vector<std::size_t> constraints;
      trace_back(all, source, node, nodes, constraints);
      const Eigen::Matrix3d expected = propagated(graph, nodes, constraints);
      EXPECT_LT((all[node].covariance - expected).norm(), 1e-6 * (1e-12 + expected.norm()));
    }
  }
}

TEST(PathCovariance, settles_the_cheapest_end_first) {
  const KnownGraph known = building(100, 2, 2);
  const PoseGraph graph = with_skewed_information(known.graph);
  for (const double lever : {0.0, 2.0}) {
    PathCovarianceOptions options;
    options.heading_lever_m = lever;
    const std::vector<RelativeUncertainty> all = path_covariances(graph, 41, options);
    const std::vector<double> expected = slow_costs(graph, 41, lever);
    for (std::size_t node = 0; node < graph.num_nodes(); ++node) {
      const Eigen::Matrix3d& covariance = all[node].covariance;
      const double cost = covariance(0, 0) + covariance(1, 1) + lever * lever * covariance(2, 2);
      EXPECT_NEAR(cost, expected[node], 1e-6 * expected[node]);
    }
  }
}

TEST(PathCovariance, is_never_below_the_covariance_of_all_constraints) {
  KnownGraph known = building(500, 2, 3);
  SparsePoseAdjustment solver;
  solver.optimize(known.graph);
  MarginalCovariance marginals;
  marginals.update(known.graph);
  for (const std::size_t source : {0, 250, 499}) {
    const std::vector<RelativeUncertainty> bounds = path_covariances(known.graph, source);
    for (std::size_t node = 0; node < 500; node += 23) {
      const Eigen::Matrix3d spare = bounds[node].covariance - marginals.relative(source, node);
      const double smallest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spare).eigenvalues()[0];
      EXPECT_GE(smallest, -1e-9) << source << " " << node;
    }
  }
}

TEST(PathCovariance, prefers_the_more_certain_way) {
  KnownGraph known = ring(100, 1, 0, 0.001, 0.0001);
  const std::vector<RelativeUncertainty> all = path_covariances(known.graph, 0);
  EXPECT_EQ(all[99].previous, 0U) << "the chain uses the loop";
  EXPECT_NEAR(all[99].position_sigma_m(), 0.001, 1e-9);
  EXPECT_EQ(all[95].previous, 96U);
  known.graph.set_enabled(known.graph.num_constraints() - 1, false);
  EXPECT_EQ(path_covariances(known.graph, 0)[99].previous, 98U);
}

TEST(PathCovariance, gives_the_deviation_of_the_worst_direction) {
  RelativeUncertainty uncertainty;
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  uncertainty.covariance.topLeftCorner<2, 2>() << 9 * c * c + s * s, 8 * s * c, 8 * s * c, 9 * s * s + c * c;
  EXPECT_NEAR(uncertainty.position_sigma_m(), 3, 1e-12);
}

TEST(PathCovariance, stops_at_a_bound_or_when_all_targets_are_reached) {
  const KnownGraph known = building(500, 2, 3);
  const std::vector<RelativeUncertainty> all = path_covariances(known.graph, 100);
  PathCovarianceOptions bounded;
  bounded.max_sigma_m = 0.1;
  const std::vector<RelativeUncertainty> near = path_covariances(known.graph, 100, bounded);
  PathCovarianceOptions aimed;
  aimed.targets = {90, 120, 120};
  const std::vector<RelativeUncertainty> some = path_covariances(known.graph, 100, aimed);
  std::size_t num_near = 0;
  std::size_t num_some = 0;
  for (std::size_t node = 0; node < 500; ++node) {
    const Eigen::Matrix3d& covariance = all[node].covariance;
    const double cost = covariance(0, 0) + covariance(1, 1) + 4 * covariance(2, 2);
    EXPECT_TRUE(near[node].reached || cost > 0.0099);
    EXPECT_TRUE(!near[node].reached || near[node].covariance == covariance);
    EXPECT_TRUE(!some[node].reached || some[node].covariance == covariance);
    num_near += near[node].reached ? 1 : 0;
    num_some += some[node].reached ? 1 : 0;
  }
  EXPECT_TRUE(some[90].reached);
  EXPECT_TRUE(some[120].reached);
  EXPECT_GT(num_near, 10U);
  EXPECT_LT(num_near, 400U);
  EXPECT_LT(num_some, 400U);
}

TEST(PathCovariance, a_search_with_targets_equals_one_of_the_whole_graph) {
  KnownGraph known = building(500, 2, 3);
  PathCovarianceSearch search;  // one object for all searches, to test the memory that it keeps
  for (std::size_t source = 0; source < 500; source += 7) {
    const std::vector<RelativeUncertainty> all = path_covariances(known.graph, source);
    PathCovarianceOptions options;
    for (const std::size_t target : {source + 3, source + 40, 2 * source + 11})
      options.targets.push_back(target % 500);
    search.run(known.graph, source, options);
    for (const std::size_t target : options.targets) EXPECT_TRUE(search.of(target).reached);
    for (std::size_t node = 0; node < 500; ++node) {
      const RelativeUncertainty found = search.of(node);
      if (!found.reached) continue;
      EXPECT_EQ(found.covariance, all[node].covariance);
      EXPECT_EQ(found.previous, all[node].previous);
      EXPECT_EQ(found.constraint, all[node].constraint);
    }
    // Moves a node, to test that the search keeps no poses.
    known.graph.set_pose(source, {0.1 * static_cast<double>(source), 1, 0.5});
  }
}

TEST(PathCovariance, the_cost_of_near_targets_does_not_depend_on_the_size) {
  std::vector<std::size_t> seen;
  for (const int nodes : {100, 1000, 10000}) {
    PoseGraph graph;
    Constraint constraint;
    for (int i = 0; i < nodes; ++i) {
      graph.add_node({1.0 * i, 0, 0});
      if (i == 0) continue;
      constraint.from = static_cast<std::size_t>(i - 1);
      constraint.to = static_cast<std::size_t>(i);
      constraint.from_T_to = {1, 0, 0};
      graph.add_constraint(constraint);
    }
    PathCovarianceOptions options;
    options.targets = {60};
    PathCovarianceSearch search;
    search.run(graph, 50, options);
    EXPECT_TRUE(search.of(60).reached);
    seen.push_back(search.nodes_seen());
  }
  EXPECT_LT(seen[0], 30U);
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_EQ(seen[0], seen[2]);
}

TEST(PathCovariance, skips_nodes_without_information) {
  PoseGraph graph;
  for (int i = 0; i < 4; ++i) graph.add_node({1.0 * i, 0, 0});
  Constraint constraint;
  constraint.to = 1;
  graph.add_constraint(constraint);
  constraint.to = 2;
  constraint.information(2, 2) = 0;  // singular, so there is no covariance
  graph.add_constraint(constraint);
  const std::vector<RelativeUncertainty> all = path_covariances(graph, 1);
  EXPECT_TRUE(all[0].reached);
  EXPECT_FALSE(all[2].reached);
  EXPECT_FALSE(all[3].reached);
  EXPECT_THROW(path_covariances(graph, 4), std::out_of_range);
  PathCovarianceOptions options;
  options.targets = {9};
  EXPECT_THROW(path_covariances(graph, 0, options), std::out_of_range);
}

TEST(PathCovariance, breaks_ties_the_same_way_every_time) {
  // Constraints of a kind have equal standard deviations, so costs tie.
  const KnownGraph known = building(300, 3, 3);
  const std::vector<RelativeUncertainty> a = path_covariances(known.graph, 150);
  const std::vector<RelativeUncertainty> b = path_covariances(known.graph, 150);
  for (std::size_t node = 0; node < 300; ++node) {
    EXPECT_EQ(a[node].constraint, b[node].constraint);
    EXPECT_EQ(a[node].covariance, b[node].covariance);
  }
}

TEST(PathCovariance, adds_the_doubt_of_each_constraint_on_request) {
  PoseGraph graph;
  for (const double x_m : {0.0, 1.0, 2.0}) graph.add_node({x_m, 0, 0});
  Constraint constraint;
  constraint.from_T_to = {1, 0, 0};
  constraint.information = Eigen::Vector3d(100, 100, 1e9).asDiagonal();
  constraint.from = 0;
  constraint.to = 1;
  constraint.doubt = Eigen::Vector3d(0.24, 0, 0).asDiagonal();
  graph.add_constraint(constraint);
  constraint.from = 1;
  constraint.to = 2;
  constraint.doubt.setZero();
  graph.add_constraint(constraint);
  PathCovarianceOptions doubtful;
  doubtful.with_doubt = true;
  EXPECT_NEAR(path_covariances(graph, 0)[2].covariance(0, 0), 0.01 + 0.01, 1e-9);
  EXPECT_NEAR(path_covariances(graph, 0, doubtful)[2].covariance(0, 0), 25 * 0.01 + 0.01, 1e-9);
}

}  // namespace
}  // namespace psi_slam
