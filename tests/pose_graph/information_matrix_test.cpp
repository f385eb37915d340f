// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/information_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "test_graphs.h"

namespace psi_slam {
namespace {

TEST(InformationMatrix, agrees_with_the_eigenvalues) {
  Measurer measurer(1);
  int accepted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Eigen::Matrix3d matrix;
    for (int k = 0; k < 9; ++k) matrix(k / 3, k % 3) = measurer.normal();
    matrix = (matrix + matrix.transpose()).eval();
    matrix.diagonal().array() += 1.5;
    const double smallest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvalues()[0];
    if (std::abs(smallest) < 1e-3) continue;
    EXPECT_EQ(is_information_matrix(matrix), smallest > 0) << matrix;
    accepted += smallest > 0 ? 1 : 0;
  }
  EXPECT_GT(accepted, 100);
}

TEST(InformationMatrix, can_lack_information_of_a_coordinate) {
  EXPECT_TRUE(is_information_matrix(Eigen::Matrix3d::Zero()));
  EXPECT_TRUE(is_information_matrix(Eigen::Vector3d(100, 0, 4).asDiagonal()));
  Eigen::Matrix3d along_one_direction = Eigen::Matrix3d::Zero();
  along_one_direction.topLeftCorner<2, 2>() << 16, 12, 12, 9;
  EXPECT_TRUE(is_information_matrix(along_one_direction));
}

TEST(InformationMatrix, tolerates_the_rounding_of_text_files) {
  Eigen::Matrix3d rounded;  // a matrix of rank 1 in x and y, rounded to six digits
  rounded << 0.333333, 0.666667, 0, 0.666667, 1.33333, 0, 0, 0, 1;
  EXPECT_TRUE(is_information_matrix(rounded));
}

TEST(InformationMatrix, rejects_other_matrices) {
  EXPECT_FALSE(is_information_matrix(Eigen::Vector3d(1, -1, 1).asDiagonal()));
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(0, 1) = 0.5;
  EXPECT_FALSE(is_information_matrix(matrix)) << "not symmetric";
  matrix(1, 0) = 0.5;
  EXPECT_TRUE(is_information_matrix(matrix));
  matrix(0, 1) = matrix(1, 0) = 1.1;
  EXPECT_FALSE(is_information_matrix(matrix)) << "indefinite";
  matrix = Eigen::Vector3d(1, 0, 1).asDiagonal();
  matrix(0, 1) = matrix(1, 0) = 0.1;
  EXPECT_FALSE(is_information_matrix(matrix)) << "y has no information, but is correlated with x";
  matrix = Eigen::Matrix3d::Identity();
  matrix(2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_information_matrix(matrix));
  matrix(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_information_matrix(matrix));
}

TEST(InTurnedAxes, turns_x_and_y_but_not_the_heading) {
  const Eigen::Matrix3d matrix = Eigen::Vector3d(4, 1, 9).asDiagonal();
  EXPECT_TRUE(
      in_turned_axes(matrix, M_PI / 2).isApprox(Eigen::Matrix3d(Eigen::Vector3d(1, 4, 9).asDiagonal())));
  const Eigen::Matrix3d by_45_deg = in_turned_axes(matrix, M_PI / 4);
  EXPECT_NEAR(by_45_deg(0, 1), 1.5, 1e-12);  // the long axis points to +x and +y
  EXPECT_TRUE(in_turned_axes(by_45_deg, -M_PI / 4).isApprox(matrix));
}

}  // namespace
}  // namespace psi_slam
