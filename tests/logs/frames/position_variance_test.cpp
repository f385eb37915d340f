// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/position_variance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace psi_slam {
namespace {

double by_eigenvalues(const Eigen::Matrix3d& covariance) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance.topLeftCorner<2, 2>())
      .eigenvalues()
      .maxCoeff();
}

TEST(PositionVariance, equals_the_largest_eigenvalue) {
  for (const double xy : {-0.6, -0.1, 0.0, 0.3, 0.7})
    for (const double yy : {0.5, 0.8, 2.0, 9.0}) {
      Eigen::Matrix3d covariance;
      covariance << 1, xy, 0.2, xy, yy, -0.3, 0.2, -0.3, 4;
      EXPECT_NEAR(largest_position_variance_m2(covariance), by_eigenvalues(covariance), 1e-12)
          << xy << " " << yy;
    }
}

TEST(PositionVariance, of_a_corridor_is_that_along_it) {
  Eigen::Matrix3d along_x = Eigen::Vector3d(1, 1e-6, 0.01).asDiagonal();
  EXPECT_EQ(largest_position_variance_m2(along_x), 1);
  const double angle_rad = M_PI / 6;
  const Eigen::Vector3d along(std::cos(angle_rad), std::sin(angle_rad), 0);
  const Eigen::Vector3d across(-std::sin(angle_rad), std::cos(angle_rad), 0);
  const Eigen::Matrix3d turned = along * along.transpose() + 1e-6 * across * across.transpose();
  EXPECT_NEAR(largest_position_variance_m2(turned), 1, 1e-12);
}

TEST(PositionVariance, is_0_without_uncertainty) {
  EXPECT_EQ(largest_position_variance_m2(Eigen::Matrix3d::Zero()), 0);
}

}  // namespace
}  // namespace psi_slam
