// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/shared_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "dense_reference.h"
#include "pose_graph/information_matrix.h"
#include "pose_graph/marginal_covariance.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kNodes = 240;
constexpr std::size_t kSegmentNodes = 6;
constexpr double kStep_m = 0.5;
// Standard deviations of a loop.
constexpr double kSigma_m = 0.02;
constexpr double kSigma_rad = 0.004;
constexpr std::size_t kFirstLoop = kNodes / 2 + 8 * kSegmentNodes;
// Share of these variances that each scan has as an error of its own.
constexpr double kScanShare = 0.05;

Eigen::Matrix3d stated() {
  return Eigen::Vector3d(kSigma_m * kSigma_m, kSigma_m * kSigma_m, kSigma_rad * kSigma_rad).asDiagonal();
}

Constraint constraint(std::size_t from, std::size_t to, const TPose2D& from_T_to, Constraint::Kind kind,
                      const Eigen::Matrix3d& covariance = stated()) {
  Constraint result;
  result.from = from;
  result.to = to;
  result.from_T_to = from_T_to;
  result.kind = kind;
  result.information = noisy_information(covariance, 0, 0);
  return result;
}

/// Two laps on a circle, mapped as a robot does. The path drifts by a random walk. Each scan hangs on the
/// first node of its path segment, with a small error of its own. Loops join scans of the second lap with the
/// segments of the first lap that saw the same place. Loops between the same two segments share 0.8 of their
/// variance. `drift_share` is the variance of the drift of a segment, as a share of that of a loop.
KnownGraph two_laps(std::uint64_t seed, double drift_share = 1) {
  KnownGraph known;
  Measurer measurer(seed);
  const double radius_m = kStep_m * kNodes / 2 / (2 * M_PI);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = 4 * M_PI * static_cast<double>(i) / kNodes;
    known.truth.emplace_back(radius_m * std::sin(angle), radius_m * (1 - std::cos(angle)), wrap_to_pi(angle));
  }
  const auto off = [&](const TPose2D& pose, double variance) {
    const double scale = std::sqrt(variance);
    return compose(pose, {scale * kSigma_m * measurer.normal(), scale * kSigma_m * measurer.normal(),
                          scale * kSigma_rad * measurer.normal()});
  };
  const double drift_of_step = drift_share / kSegmentNodes;
  known.graph.add_node(known.truth[0]);
  std::vector<TPose2D> drifted{known.truth[0]};
  Eigen::Matrix3d drift = Eigen::Matrix3d::Zero();  // since the first node of the segment, in its axes
  for (std::size_t i = 1; i < kNodes; ++i) {
    drifted.push_back(
        compose(drifted.back(), off(relative_pose(known.truth[i - 1], known.truth[i]), drift_of_step)));
    const std::size_t first = (i - 1) / kSegmentNodes * kSegmentNodes;
    const TPose2D before = relative_pose(drifted[first], drifted[i - 1]);
    const TPose2D here = relative_pose(drifted[first], drifted[i]);
    Eigen::Matrix3d moved = Eigen::Matrix3d::Identity();
    moved(0, 2) = before.y - here.y;
    moved(1, 2) = here.x - before.x;
    drift = moved * drift * moved.transpose() + drift_of_step * stated();
    const bool begins = i % kSegmentNodes == 0;
    const TPose2D first_T_scan = begins ? here : off(here, kScanShare);
    known.graph.add_node(compose(known.graph.pose(first), first_T_scan));
    const Eigen::Matrix3d covariance = begins ? drift : Eigen::Matrix3d(drift + kScanShare * stated());
    known.graph.add_constraint(constraint(first, i, first_T_scan, Constraint::Kind::kLocalMap, covariance));
    if (begins) drift.setZero();
  }
  TPose2D common;
  for (std::size_t i = kFirstLoop; i < kNodes; ++i) {
    if (i % kSegmentNodes == 0) common = off({0, 0, 0}, 0.8);
    const std::size_t reference = (i - kNodes / 2) / kSegmentNodes * kSegmentNodes;
    const TPose2D measured =
        compose(compose(relative_pose(known.truth[reference], known.truth[i]), common), off({0, 0, 0}, 0.2));
    known.graph.add_constraint(constraint(reference, i, measured, Constraint::Kind::kLoop));
  }
  return known;
}

constexpr std::size_t kFirstJudged = 40;  // earlier nodes have hardly drifted

double mean_normalised_square(const KnownGraph& known, const std::vector<Eigen::Matrix3d>& covariances) {
  double sum = 0;
  for (std::size_t i = kFirstJudged; i < kNodes; ++i) {
    const TPose2D& pose = known.graph.pose(i);
    const TPose2D& truth = known.truth[i];
    const Eigen::Vector3d error(pose.x - truth.x, pose.y - truth.y, wrap_to_pi(pose.phi - truth.phi));
    sum += error.dot(covariances[i].ldlt().solve(error)) / 3;
  }
  return sum / static_cast<double>(kNodes - kFirstJudged);
}

TEST(SharedErrors, segments_are_named_by_their_first_nodes) {
  const PoseGraph graph = two_laps(1).graph;
  const std::vector<std::size_t> segments = segments_of(graph);
  ASSERT_EQ(segments.size(), kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(segments[i], i / kSegmentNodes * kSegmentNodes) << i;
}

TEST(SharedErrors, covariances_are_the_dense_inverse_of_the_model) {
  const PoseGraph graph = two_laps(1).graph;
  const PoseGraph model = graph_with_shared_errors(graph);
  EXPECT_EQ(model.num_nodes(), graph.num_nodes());
  EXPECT_EQ(model.num_constraints(), kNodes - 1 + 12) << "loops join 12 pairs of segments";
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

// Mean normalised squares, by `covariances`, of the nodes that loops join to the segments they saw before.
double mean_square_across_loops(const KnownGraph& known, MarginalCovariance& covariances) {
  double sum = 0;
  for (std::size_t i = kFirstLoop; i < kNodes; i += kSegmentNodes) {
    const std::size_t seen = i - kNodes / 2;
    const TPose2D found = relative_pose(known.graph.pose(seen), known.graph.pose(i));
    const TPose2D truth = relative_pose(known.truth[seen], known.truth[i]);
    const Eigen::Vector3d error(found.x - truth.x, found.y - truth.y, wrap_to_pi(found.phi - truth.phi));
    sum += error.dot(covariances.relative(seen, i).ldlt().solve(error)) / 3;
  }
  return sum * kSegmentNodes / static_cast<double>(kNodes - kFirstLoop);
}

// Returns the graph, with the loops between two segments weighted as the model weights them.
PoseGraph weighted_as_in_the_model(const PoseGraph& graph) {
  PoseGraph result;
  for (const TPose2D& pose : graph.poses()) result.add_node(pose);
  for (Constraint one : graph.constraints()) {
    if (one.kind == Constraint::Kind::kLoop)
      one.information /= kSegmentNodes * kCommonLoopShare + (1 - kCommonLoopShare);
    result.add_constraint(one);
  }
  return result;
}

/// Mean normalised squares over many graphs: 1 for correct covariances.
struct MeanSquares {
  double to_root = 0;
  double across_loops = 0;
  double across_loops_of_model = 0;  ///< at the poses that are best by the weights of the model
  double independent = 0;            ///< across loops, by the covariances of the solver

  explicit MeanSquares(double drift_share) {
    constexpr int kRuns = 40;
    for (int run = 0; run < kRuns; ++run) {
      KnownGraph known = two_laps(100 + static_cast<std::uint64_t>(run), drift_share);
      SparsePoseAdjustment().optimize(known.graph);
      to_root += mean_normalised_square(known, pose_covariances(known.graph)) / kRuns;
      MarginalCovariance model;
      model.update(graph_with_shared_errors(known.graph));
      across_loops += mean_square_across_loops(known, model) / kRuns;
      MarginalCovariance solver;
      solver.update(known.graph);
      independent += mean_square_across_loops(known, solver) / kRuns;
      known.graph = weighted_as_in_the_model(known.graph);
      SparsePoseAdjustment().optimize(known.graph);
      across_loops_of_model += mean_square_across_loops(known, model) / kRuns;
    }
  }
};

// The loops of these graphs have the correlations that the model assumes, and the path hardly drifts within a
// segment. A solver takes the loops for independent, so its covariances are too small across loops.
TEST(SharedErrors, covariances_fit_errors_with_known_correlation) {
  const MeanSquares squares(0.1);
  EXPECT_GT(squares.to_root, 0.8);
  EXPECT_LT(squares.to_root, 1.25);
  EXPECT_GT(squares.across_loops_of_model, 0.85);
  EXPECT_LT(squares.across_loops_of_model, 1.15);
  EXPECT_LT(squares.across_loops, 1.5) << "the solver gives the loops more weight than is best";
  EXPECT_GT(squares.independent, 2 * squares.across_loops);
}

// Here, the drift from one segment to the next has the variance of a loop. The model joins the loops at the
// first nodes, so it leaves out the drift between the first node of a segment and the scans of its loops.
TEST(SharedErrors, covariances_are_a_little_too_small_if_the_path_drifts_as_much_as_loops_err) {
  const MeanSquares squares(1);
  EXPECT_GT(squares.to_root, 0.8);
  EXPECT_LT(squares.to_root, 1.25);
  EXPECT_LT(squares.across_loops_of_model, 1.5);
  EXPECT_LT(squares.across_loops, 1.7);
  EXPECT_GT(squares.independent, 2 * squares.across_loops);
}

TEST(SharedErrors, more_loops_between_the_same_segments_add_hardly_any_information) {
  const PoseGraph once = two_laps(2).graph;
  PoseGraph twice = once;
  for (std::size_t i = 0; i < once.num_constraints(); ++i)
    if (once.constraint(i).kind == Constraint::Kind::kLoop) twice.add_constraint(once.constraint(i));
  const Eigen::Matrix3d of_once = pose_covariance(once, kNodes - 1);
  const Eigen::Matrix3d of_twice = pose_covariance(twice, kNodes - 1);
  EXPECT_LT(of_twice.trace(), of_once.trace());
  EXPECT_GT(of_twice.trace(), 0.9 * of_once.trace());
}

// Two segments along x with three nodes each, and a turned first pose.
PoseGraph two_segments() {
  PoseGraph graph;
  for (int i = 0; i < 6; ++i) graph.add_node(compose({1, 2, 0.6}, {i * kStep_m, 0, 0}));
  for (const auto& [from, to] : {std::pair(0U, 1U), {0U, 2U}, {0U, 3U}, {3U, 4U}, {3U, 5U}})
    graph.add_constraint(
        constraint(from, to, relative_pose(graph.pose(from), graph.pose(to)), Constraint::Kind::kLocalMap));
  return graph;
}

TEST(SharedErrors, joins_the_loops_between_two_segments_in_both_directions) {
  PoseGraph graph = two_segments();
  Eigen::Matrix3d along_path = stated();
  along_path(0, 0) *= 9;
  const auto loop = [&](std::size_t from, std::size_t to) {
    return constraint(from, to, relative_pose(graph.pose(from), graph.pose(to)), Constraint::Kind::kLoop,
                      along_path);
  };
  graph.add_constraint(loop(0, 4));
  graph.add_constraint(loop(5, 1));
  graph.add_constraint(loop(0, 5));
  graph.add_constraint(loop(1, 2));
  const PoseGraph model = graph_with_shared_errors(graph);
  ASSERT_EQ(model.num_constraints(), 5U + 1 + 1);
  EXPECT_EQ(model.constraint(5).from, 1U) << "a loop within one segment stays";
  EXPECT_TRUE(model.constraint(5).information.isApprox(along_path.inverse(), 1e-9));
  const Constraint& joined = model.constraint(6);
  EXPECT_EQ(joined.kind, Constraint::Kind::kLoop);
  EXPECT_EQ(joined.from, 0U);
  EXPECT_EQ(joined.to, 3U);
  const double share = kCommonLoopShare + (1 - kCommonLoopShare) / 3;
  EXPECT_TRUE(joined.information.inverse().isApprox(share * along_path, 1e-9))
      << joined.information.inverse();
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

TEST(SharedErrors, refuses_singular_loops_between_two_segments) {
  PoseGraph graph = two_segments();
  Constraint flat = constraint(0, 4, {2, 0, 0}, Constraint::Kind::kLoop);
  flat.information(2, 2) = 0;
  graph.add_constraint(flat);
  EXPECT_THROW(graph_with_shared_errors(graph), UserError);
  EXPECT_THROW(pose_covariances(graph), UserError);
  graph.add_constraint(constraint(0, 5, {2.5, 0, 0}, Constraint::Kind::kLoop));
  EXPECT_NO_THROW(graph_with_shared_errors(graph)) << "another loop of the segments determines the heading";
}

}  // namespace
}  // namespace psi_slam
