// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/marginal_covariance.h"

#include <gtest/gtest.h>

#include "dense_reference.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

bool near(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() <= 1e-6 * b.cwiseAbs().maxCoeff();
}

// Returns the joint covariance of two nodes from the inverse of the dense system; the root must be node 0.
Matrix6d dense_joint(const Eigen::MatrixXd& inverse, std::size_t a, std::size_t b) {
  Matrix6d joint = Matrix6d::Zero();
  const std::size_t nodes[2] = {a, b};
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 2; ++c)
      if (nodes[r] != 0 && nodes[c] != 0)
        joint.block<3, 3>(3 * r, 3 * c) = inverse.block<3, 3>(3 * static_cast<Eigen::Index>(nodes[r]) - 3,
                                                              3 * static_cast<Eigen::Index>(nodes[c]) - 3);
  return joint;
}

TEST(MarginalCovariance, is_a_block_of_the_dense_inverse) {
  const KnownGraph known = building(150, 2, 2);
  const Eigen::MatrixXd inverse = held_at_root(dense_system(known.graph)).h.inverse();
  MarginalCovariance covariance;
  covariance.update(known.graph);
  EXPECT_EQ(covariance.marginal(0), Eigen::Matrix3d::Zero());
  const std::vector<Eigen::Matrix3d> all = covariance.marginals();
  ASSERT_EQ(all.size(), 150U);
  for (std::size_t a = 0; a < 150; ++a)
    EXPECT_TRUE(near(all[a], dense_joint(inverse, a, a).topLeftCorner<3, 3>()) || a == 0);
  EXPECT_EQ(all[0], Eigen::Matrix3d::Zero());
  for (std::size_t a = 0; a < 150; a += 7) {
    EXPECT_TRUE(near(covariance.marginal(a), dense_joint(inverse, a, a).topLeftCorner<3, 3>()) || a == 0);
    for (std::size_t b = 0; b < 150; b += 11)
      EXPECT_TRUE(near(covariance.joint(a, b), dense_joint(inverse, a, b)) || a + b == 0) << a << " " << b;
  }
}

TEST(MarginalCovariance, with_a_weighted_sum_follows_from_the_dense_inverse) {
  const KnownGraph known = building(60, 2, 2);
  const Eigen::MatrixXd inverse = held_at_root(dense_system(known.graph)).h.inverse();
  MarginalCovariance covariance;
  covariance.update(known.graph);
  std::vector<Eigen::Vector3d> weights(60, Eigen::Vector3d::Zero());
  weights[0] = {1, 1, 1};  // of the root, which is exact
  weights[17] = {0.5, -1, 2};
  weights[42] = {3, 0, -0.2};
  const std::vector<Eigen::Vector3d> all = covariance.covariances_with_sum(weights);
  EXPECT_EQ(all[0], Eigen::Vector3d::Zero());
  for (std::size_t a = 1; a < 60; a += 5)
    EXPECT_TRUE(near(all[a], dense_joint(inverse, a, 17).topRightCorner<3, 3>() * weights[17] +
                                 dense_joint(inverse, a, 42).topRightCorner<3, 3>() * weights[42]))
        << a;
}

TEST(MarginalCovariance, of_a_relative_pose_follows_from_the_joint_one) {
  const KnownGraph known = building(150, 2, 2);
  const Eigen::MatrixXd inverse = held_at_root(dense_system(known.graph)).h.inverse();
  MarginalCovariance covariance;
  covariance.update(known.graph);
  const std::vector<std::size_t> others = {0, 3, 40, 77, 149};
  for (const std::size_t a : {0, 20, 78}) {
    const std::vector<Eigen::Matrix3d> all = covariance.relative(a, others);
    for (std::size_t k = 0; k < others.size(); ++k) {
      const Eigen::Matrix<double, 3, 6> jacobian =
          numeric_jacobian({}, known.graph.pose(a), known.graph.pose(others[k]));
      const Eigen::MatrixXd expected = jacobian * dense_joint(inverse, a, others[k]) * jacobian.transpose();
      EXPECT_TRUE(near(all[k], expected) || a + others[k] == 0);
      EXPECT_EQ(covariance.relative(a, others[k]), all[k]);
    }
  }
}

TEST(MarginalCovariance, is_that_of_the_measurement_between_two_nodes) {
  PoseGraph graph;
  graph.add_node({1, 2, 0.5});
  graph.add_node({3, 1, -1});
  Constraint constraint;
  constraint.to = 1;
  constraint.from_T_to = relative_pose(graph.pose(0), graph.pose(1));
  constraint.information << 40, 7, -3, 7, 90, 5, -3, 5, 200;
  graph.add_constraint(constraint);
  MarginalCovariance covariance;
  covariance.update(graph);
  EXPECT_TRUE(near(covariance.relative(0, 1), constraint.information.inverse()));
}

TEST(MarginalCovariance, counts_constraints_by_their_weights) {
  const KnownGraph known = ring(50, 3, 1);
  PoseGraph without = known.graph;
  std::vector<double> weights(known.graph.num_constraints(), 1);
  for (std::size_t i = 49; i < weights.size(); ++i) {
    weights[i] = 0;
    without.set_enabled(i, false);
  }
  MarginalCovariance weighted;
  weighted.update(known.graph, weights);
  MarginalCovariance disabled;
  disabled.update(without);
  MarginalCovariance full;
  full.update(known.graph);
  EXPECT_TRUE(near(weighted.marginal(49), disabled.marginal(49)));
  EXPECT_GT(weighted.marginal(49).trace(), 10 * full.marginal(49).trace());
}

TEST(MarginalCovariance, reports_an_undetermined_pose) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({1, 0, 0});
  Constraint constraint;
  constraint.to = 1;
  constraint.from_T_to = {1, 0, 0};
  constraint.information = Eigen::Vector3d(1, 1, 0).asDiagonal();
  graph.add_constraint(constraint);
  MarginalCovariance covariance;
  EXPECT_THROW(covariance.update(graph), UserError);
  EXPECT_THROW(covariance.marginal(1), std::out_of_range) << "there is no covariance after a failed update";
}

}  // namespace
}  // namespace psi_slam
