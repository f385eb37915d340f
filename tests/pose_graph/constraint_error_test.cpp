// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/constraint_error.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "test_graphs.h"

namespace psi_slam {
namespace {

TPose2D random_pose(Measurer& measurer, double extent) {
  return {extent * (2 * measurer.uniform() - 1), extent * (2 * measurer.uniform() - 1),
          M_PI * (2 * measurer.uniform() - 1)};
}

TPose2D moved(TPose2D pose, int coordinate, double by) {
  (coordinate == 0 ? pose.x : coordinate == 1 ? pose.y : pose.phi) += by;
  return pose;
}

TEST(ConstraintError, is_zero_if_the_poses_agree_with_the_measurement) {
  Measurer measurer(1);
  for (int i = 0; i < 100; ++i) {
    const TPose2D a = random_pose(measurer, 50);
    const TPose2D b = random_pose(measurer, 50);
    EXPECT_LT(constraint_error(relative_pose(a, b), RotatedPose(a), RotatedPose(b)).norm(), 1e-12);
  }
}

TEST(ConstraintError, is_measured_minus_predicted_in_the_axes_of_the_first_node) {
  const RotatedPose a({1, 2, M_PI / 2});
  const RotatedPose b({1, 5, M_PI / 2});  // 3 m straight ahead of `a`
  const Eigen::Vector3d error = constraint_error({3.5, 0.25, 0.1}, a, b);
  EXPECT_NEAR(error.x(), 0.5, 1e-12);
  EXPECT_NEAR(error.y(), 0.25, 1e-12);
  EXPECT_NEAR(error.z(), 0.1, 1e-12);
}

TEST(ConstraintError, takes_the_short_way_round) {
  const RotatedPose a({0, 0, 3.1});
  const RotatedPose b({0, 0, -3.1});
  EXPECT_NEAR(constraint_error({0, 0, 0}, a, b).z(), -(2 * M_PI - 6.2), 1e-12);
  EXPECT_NEAR(constraint_error({0, 0, 3.1}, a, RotatedPose({0, 0, 0})).z(), 6.2 - 2 * M_PI, 1e-12);
}

TEST(ConstraintError, its_jacobians_are_the_numeric_ones) {
  Measurer measurer(2);
  constexpr double kStep = 1e-6;
  for (int trial = 0; trial < 100; ++trial) {
    const TPose2D a = random_pose(measurer, 20);
    const TPose2D b = random_pose(measurer, 20);
    const TPose2D z = compose(relative_pose(a, b), {0.1, -0.2, 0.3});
    const ConstraintJacobians jacobians = constraint_jacobians(RotatedPose(a), RotatedPose(b));
    for (int k = 0; k < 3; ++k) {
      const auto at = [&](const TPose2D& i, const TPose2D& j) {
        return constraint_error(z, RotatedPose(i), RotatedPose(j));
      };
      const Eigen::Vector3d wrt_i = (at(moved(a, k, kStep), b) - at(moved(a, k, -kStep), b)) / (2 * kStep);
      const Eigen::Vector3d wrt_j = (at(a, moved(b, k, kStep)) - at(a, moved(b, k, -kStep))) / (2 * kStep);
      EXPECT_LT((wrt_i - jacobians.wrt_i.col(k)).norm(), 1e-7);
      EXPECT_LT((wrt_j - jacobians.wrt_j.col(k)).norm(), 1e-7);
    }
  }
}

TEST(ConstraintError, its_normal_equations_are_the_products_of_the_jacobians) {
  Measurer measurer(3);
  for (int trial = 0; trial < 100; ++trial) {
    const RotatedPose a(random_pose(measurer, 20));
    const RotatedPose b(random_pose(measurer, 20));
    Eigen::Matrix3d root;
    for (int k = 0; k < 9; ++k) root(k / 3, k % 3) = measurer.normal();
    const Eigen::Matrix3d information = root * root.transpose();
    const Eigen::Vector3d error(measurer.normal(), measurer.normal(), measurer.normal());
    const ConstraintJacobians jacobians = constraint_jacobians(a, b);
    const ConstraintNormals normals = constraint_normals(information, error, a, b);
    const auto near = [](const auto& x, const auto& y) { return (x - y).norm() <= 1e-12 * (1 + y.norm()); };
    EXPECT_TRUE(near(normals.ii, jacobians.wrt_i.transpose() * information * jacobians.wrt_i));
    EXPECT_TRUE(near(normals.ij, jacobians.wrt_i.transpose() * information * jacobians.wrt_j));
    EXPECT_TRUE(near(normals.jj, jacobians.wrt_j.transpose() * information * jacobians.wrt_j));
    EXPECT_TRUE(near(normals.i, jacobians.wrt_i.transpose() * information * error));
    EXPECT_TRUE(near(normals.j, jacobians.wrt_j.transpose() * information * error));
  }
}

TEST(WrapToPi, gives_the_same_angle_in_the_half_open_interval) {
  for (int i = -4000; i <= 4000; ++i) {
    const double angle = 0.01 * i;
    const double wrapped = wrap_to_pi(angle);
    EXPECT_GT(wrapped, -M_PI);
    EXPECT_LE(wrapped, M_PI);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-13);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-13);
  }
}

TEST(WrapToPi, takes_half_a_turn_as_positive) {
  EXPECT_EQ(wrap_to_pi(M_PI), M_PI);
  EXPECT_EQ(wrap_to_pi(-M_PI), M_PI);
  EXPECT_EQ(wrap_to_pi(3 * M_PI), M_PI);
}

TEST(WrapToPi, leaves_an_angle_of_the_interval_as_it_is) {
  for (const double angle : {0.0, 1.0, -3.14159, 3.14159, -1e-300}) EXPECT_EQ(wrap_to_pi(angle), angle);
}

}  // namespace
}  // namespace psi_slam
