// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/shared_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "dense_reference.h"
#include "pose_graph/marginal_covariance.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kNodes = 240;
constexpr std::size_t kMapNodes = 40;
constexpr double kStep_m = 0.5;
constexpr double kSigma_m = 0.02;  // stated for each constraint
constexpr double kSigma_rad = 0.004;

Constraint constraint(std::size_t from, std::size_t to, const TPose2D& from_T_to, Constraint::Kind kind) {
  Constraint result;
  result.from = from;
  result.to = to;
  result.from_T_to = from_T_to;
  result.kind = kind;
  result.information =
      Eigen::Vector3d(1 / (kSigma_m * kSigma_m), 1 / (kSigma_m * kSigma_m), 1 / (kSigma_rad * kSigma_rad))
          .asDiagonal();
  return result;
}

Eigen::Matrix3d stated() {
  return Eigen::Vector3d(kSigma_m * kSigma_m, kSigma_m * kSigma_m, kSigma_rad * kSigma_rad).asDiagonal();
}

/// Two laps on a circle, mapped as a robot does. The front end drifts by a random walk, whose variance over a
/// local map is twice `drift` times the stated variance. Each scan has a small error of its own. Two local
/// maps hold each node. A loop joins a scan of the second lap with the scans of the first lap that are
/// nearest; the error of a loop is constant over six nodes.
KnownGraph two_laps(std::uint64_t seed, double noise = 1, double drift = 1) {
  KnownGraph known;
  Measurer measurer(seed);
  const double radius_m = kStep_m * kNodes / 2 / (2 * M_PI);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = 4 * M_PI * static_cast<double>(i) / kNodes;
    known.truth.emplace_back(radius_m * std::sin(angle), radius_m * (1 - std::cos(angle)), wrap_to_pi(angle));
  }
  const auto off = [&](const TPose2D& pose, double variance) {
    const double scale = noise * std::sqrt(variance);
    return compose(pose, {scale * kSigma_m * measurer.normal(), scale * kSigma_m * measurer.normal(),
                          scale * kSigma_rad * measurer.normal()});
  };
  std::vector<TPose2D> content{known.truth[0]};  // poses by the front end
  std::vector<TPose2D> front_end{known.truth[0]};
  for (std::size_t i = 1; i < kNodes; ++i) {
    content.push_back(compose(content.back(),
                              off(relative_pose(known.truth[i - 1], known.truth[i]), 2 * drift / kMapNodes)));
    front_end.push_back(off(content.back(), 0.2));
  }
  for (const TPose2D& pose : front_end) known.graph.add_node(pose);
  for (std::size_t i = 1; i < kNodes; ++i) {
    const std::size_t half = (i - 1) / (kMapNodes / 2);
    for (const std::size_t map : {half, half + 1}) {
      if (map == 0) continue;
      const std::size_t anchor = (map - 1) * kMapNodes / 2;
      known.graph.add_constraint(
          constraint(anchor, i, relative_pose(front_end[anchor], front_end[i]), Constraint::Kind::kLocalMap));
    }
  }
  TPose2D common;
  for (std::size_t i = kNodes / 2 + kMapNodes; i < kNodes; ++i) {
    if (i % 6 == 0) common = off({0, 0, 0}, 0.8);
    const std::size_t seen = i - kNodes / 2;
    const std::size_t anchor = seen / (kMapNodes / 2) * (kMapNodes / 2) - kMapNodes / 2;
    const TPose2D measured =
        compose(compose(relative_pose(known.truth[seen], known.truth[i]), common), off({0, 0, 0}, 0.2));
    known.graph.add_constraint(constraint(anchor, i,
                                          compose(relative_pose(front_end[anchor], content[seen]), measured),
                                          Constraint::Kind::kLoop));
  }
  return known;
}

SharedErrorOptions random_walk() {
  SharedErrorOptions options;
  options.drift_position_factor = 1;
  return options;
}

double mean_normalised_square(const KnownGraph& known, const std::vector<Eigen::Matrix3d>& covariances) {
  double sum = 0;
  for (std::size_t i = kMapNodes; i < kNodes; ++i) {
    const TPose2D& pose = known.graph.pose(i);
    const TPose2D& truth = known.truth[i];
    const Eigen::Vector3d error(pose.x - truth.x, pose.y - truth.y, wrap_to_pi(pose.phi - truth.phi));
    sum += error.dot(covariances[i].ldlt().solve(error)) / 3;
  }
  return sum / static_cast<double>(kNodes - kMapNodes);
}

TEST(SharedErrors, covariances_are_the_dense_inverse_of_the_model) {
  const PoseGraph graph = two_laps(1).graph;
  const PoseGraph model = graph_with_shared_errors(graph);
  EXPECT_GT(model.num_nodes(), graph.num_nodes() + 30);
  EXPECT_LT(model.num_nodes(), graph.num_nodes() + 45);
  const Eigen::MatrixXd inverse = held_at_root(dense_system(model)).h.inverse();
  const std::vector<Eigen::Matrix3d> covariances = pose_covariances(graph);
  ASSERT_EQ(covariances.size(), graph.num_nodes());
  EXPECT_EQ(covariances[0], Eigen::Matrix3d::Zero());
  for (std::size_t i = 1; i < graph.num_nodes(); i += 7) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) - 3;
    const Eigen::Matrix3d expected = inverse.block<3, 3>(row, row);
    const double largest = expected.cwiseAbs().maxCoeff();
    EXPECT_LT((covariances[i] - expected).cwiseAbs().maxCoeff(), 1e-6 * largest) << i;
    EXPECT_LT((pose_covariance(graph, i) - expected).cwiseAbs().maxCoeff(), 1e-6 * largest) << i;
  }
}

// The errors of these graphs have exactly the correlations that the model assumes, and those that a solver
// assumes are too small by far.
TEST(SharedErrors, covariances_fit_errors_with_known_correlation) {
  constexpr int kRuns = 40;
  double shared = 0;
  double independent = 0;
  for (int run = 0; run < kRuns; ++run) {
    KnownGraph known = two_laps(100 + static_cast<std::uint64_t>(run));
    SparsePoseAdjustment().optimize(known.graph);
    shared += mean_normalised_square(known, pose_covariances(known.graph, random_walk())) / kRuns;
    MarginalCovariance solver;
    solver.update(known.graph);
    independent += mean_normalised_square(known, solver.marginals()) / kRuns;
  }
  EXPECT_GT(shared, 0.85);
  EXPECT_LT(shared, 1.3);
  EXPECT_GT(independent, 6);
}

TEST(SharedErrors, more_scans_of_one_stretch_do_not_add_information) {
  const PoseGraph once = two_laps(2).graph;
  PoseGraph twice = once;
  for (std::size_t i = 0; i < once.num_constraints(); ++i)
    if (once.constraint(i).kind == Constraint::Kind::kLoop) twice.add_constraint(once.constraint(i));
  const Eigen::Matrix3d of_once = pose_covariance(once, kNodes - 1);
  const Eigen::Matrix3d of_twice = pose_covariance(twice, kNodes - 1);
  EXPECT_LT(of_twice.trace(), of_once.trace());
  EXPECT_GT(of_twice.trace(), 0.9 * of_once.trace());
}

TEST(SharedErrors, poses_agree_with_all_constraints_of_the_model) {
  KnownGraph known = two_laps(3);
  const PoseGraph model = graph_with_shared_errors(known.graph);
  EXPECT_LT(model.chi2(), 1e-12);
  EXPECT_EQ(model.root(), known.graph.root());
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(model.pose(i), known.graph.pose(i));
}

TEST(SharedErrors, ignores_constraints_that_are_switched_off) {
  PoseGraph graph = two_laps(4).graph;
  PoseGraph without_loops;
  for (const TPose2D& pose : graph.poses()) without_loops.add_node(pose);
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    if (graph.constraint(i).kind == Constraint::Kind::kLoop) {
      graph.set_enabled(i, false);
    } else {
      without_loops.add_constraint(graph.constraint(i));
    }
  }
  EXPECT_EQ(pose_covariance(graph, kNodes - 1), pose_covariance(without_loops, kNodes - 1));
}

// A second run that a weak constraint joins to the first one. No drift connects the runs.
TEST(SharedErrors, keep_the_start_of_a_run_as_an_independent_constraint) {
  PoseGraph graph;
  for (int i = 0; i < 20; ++i) graph.add_node({i * kStep_m, 0, 0});
  for (std::size_t i = 1; i < 10; ++i)
    graph.add_constraint(
        constraint(0, i, {static_cast<double>(i) * kStep_m, 0, 0}, Constraint::Kind::kLocalMap));
  for (std::size_t i = 11; i < 20; ++i)
    graph.add_constraint(
        constraint(10, i, {static_cast<double>(i - 10) * kStep_m, 0, 0}, Constraint::Kind::kLocalMap));
  Constraint start = constraint(9, 10, {kStep_m, 0, 0}, Constraint::Kind::kRunStart);
  start.information = Eigen::Vector3d(4, 4, 100).asDiagonal();
  graph.add_constraint(start);
  const std::vector<Eigen::Matrix3d> covariances = pose_covariances(graph);
  EXPECT_LT(covariances[9](0, 0), 4 * stated()(0, 0));
  EXPECT_NEAR(covariances[10](0, 0), 0.25, 0.01);
  EXPECT_NEAR(covariances[10](2, 2), 0.01, 0.001);
}

TEST(SharedErrors, of_small_graphs) {
  PoseGraph graph;
  EXPECT_TRUE(pose_covariances(graph).empty());
  graph.add_node({1, 2, 0.5});
  EXPECT_EQ(pose_covariances(graph), std::vector<Eigen::Matrix3d>{Eigen::Matrix3d::Zero()});
  graph.add_node({2, 2, 0.5});
  EXPECT_THROW(pose_covariances(graph), UserError) << "node 1 is not linked to the root";
  Constraint odometry = constraint(0, 1, graph.pose(1) - graph.pose(0), Constraint::Kind::kOdometry);
  graph.add_constraint(odometry);
  const Eigen::Matrix3d covariance = pose_covariances(graph)[1];
  EXPECT_NEAR(covariance(2, 2), kSigma_rad * kSigma_rad, 1e-9);
}

TEST(SharedErrors, refuses_a_singular_constraint_of_a_local_map) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({1, 0, 0});
  Constraint flat = constraint(0, 1, {1, 0, 0}, Constraint::Kind::kLocalMap);
  flat.information(2, 2) = 0;
  graph.add_constraint(flat);
  EXPECT_THROW(graph_with_shared_errors(graph), UserError);
}

}  // namespace
}  // namespace psi_slam
