// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/covariance_check.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "base/random_draws.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

Eigen::Matrix3d some_covariance() {
  Eigen::Matrix3d covariance;
  covariance << 4e-4, 1e-4, 1e-5,  //
      1e-4, 9e-4, -2e-5,           //
      1e-5, -2e-5, 1e-5;
  return covariance;
}

TPose2D measured(const TPose2D& truth, const Eigen::Matrix3d& covariance, RandomDraws& random) {
  const Eigen::Vector3d unit(random.normal(), random.normal(), random.normal());
  const Eigen::Vector3d error = covariance.llt().matrixL() * unit;
  return {truth.x + error.x(), truth.y + error.y(), truth.phi + error.z()};
}

std::vector<double> drawn_squares(double stated_share_of_sigma) {
  RandomDraws random(4, "covariances", 0);
  const Eigen::Matrix3d information =
      (some_covariance() * stated_share_of_sigma * stated_share_of_sigma).inverse();
  std::vector<double> squares;
  for (int i = 0; i < 20000; ++i) {
    const TPose2D truth(random.plus_minus(5), random.plus_minus(5), random.plus_minus(3.2));
    squares.push_back(normalised_square(measured(truth, some_covariance(), random), truth, information));
  }
  return squares;
}

TEST(CovarianceCheck, accepts_correct_covariances) {
  const NormalisedErrors errors = normalised_errors("x", drawn_squares(1));
  EXPECT_EQ(errors.of, "x");
  EXPECT_EQ(errors.count, 20000U);
  EXPECT_NEAR(errors.mean, 1, 0.03);
  EXPECT_NEAR(errors.median, 1, 0.03);
  EXPECT_NEAR(errors.beyond_95, 0.05, 0.006);
}

TEST(CovarianceCheck, detects_standard_deviations_that_are_half_as_large) {
  const NormalisedErrors errors = normalised_errors("x", drawn_squares(0.5));
  EXPECT_NEAR(errors.mean, 4, 0.1);
  EXPECT_NEAR(errors.median, 4, 0.1);
  EXPECT_NEAR(errors.beyond_95, 0.58, 0.02);  // P(chi-square of 3 > 7.815 / 4)
}

TEST(CovarianceCheck, is_zero_without_errors) {
  const NormalisedErrors errors = normalised_errors("x", {});
  EXPECT_EQ(errors.count, 0U);
  EXPECT_EQ(errors.mean, 0);
  EXPECT_EQ(errors.beyond_95, 0);
}

// Checks a chain of nodes with one loop. The noise of each measurement has the covariance of its constraint.
TEST(CovarianceCheck, distinguishes_local_maps_loops_and_pairs) {
  RandomDraws random(9, "chain", 0);
  constexpr std::size_t kNodes = 400;
  MappingResult result;
  Trajectory truth;
  PoseGraph graph;
  TPose2D pose(0, 0, 0);
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (i > 0) pose = pose + TPose2D(0.5, 0, 2 * M_PI / kNodes);
    truth.push_back({static_cast<TimeUs>(i), pose});
    result.node_frames.push_back(i);
    graph.add_node(pose);
  }
  const auto link = [&](std::size_t from, std::size_t to) {
    Constraint constraint;
    constraint.from = from;
    constraint.to = to;
    constraint.from_T_to = measured(truth[to].pose - truth[from].pose, some_covariance(), random);
    constraint.information = some_covariance().inverse();
    graph.add_constraint(constraint);
  };
  for (std::size_t i = 1; i < kNodes; ++i) link(i - 1, i);
  link(0, kNodes - 1);
  LoopRecord loop;
  loop.anchor = 0;
  loop.node = kNodes - 1;
  loop.state = LoopState::kAccepted;
  result.loops.push_back(loop);
  SparsePoseAdjustment().optimize(graph);
  result.graph = graph;

  const std::vector<NormalisedErrors> errors = check_covariances(result, truth, 1);
  ASSERT_EQ(errors.size(), 7U);
  EXPECT_EQ(errors[0].count, kNodes - 1);
  EXPECT_NEAR(errors[0].mean, 1, 0.2);
  EXPECT_EQ(errors[1].count, 1U);
  EXPECT_EQ(errors[2].count, 600U);
  EXPECT_EQ(errors[3].count, 600U);
  EXPECT_GT(errors[3].mean, 0.2);  // errors of pairs in one graph are correlated
  EXPECT_LT(errors[3].mean, 4);
  EXPECT_LT(errors[2].mean, errors[3].mean);  // a path contains less information than the graph
  EXPECT_EQ(errors[4].of, "any two nodes, by the whole graph");
  for (std::size_t i = 4; i < 7; ++i) {  // these constraints, of odometry, share no errors
    EXPECT_GT(errors[i].count, 500U) << errors[i].of;
    EXPECT_GT(errors[i].mean, 0.2) << errors[i].of;
    EXPECT_LT(errors[i].mean, 4) << errors[i].of;
  }
}

}  // namespace
}  // namespace psi_slam
