// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/pose_operations.h"

#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>

#include <cmath>

namespace psi_slam {
namespace {

TEST(PoseOperations, inverse_equals_that_of_mrpts_matrices) {
  for (const mrpt::math::TPose2D& pose :
       {mrpt::math::TPose2D(3, -2, 0.7), mrpt::math::TPose2D(0, 5, -3.1), mrpt::math::TPose2D(0, 0, 0)}) {
    const mrpt::math::TPose2D expected = (-mrpt::poses::CPose2D(pose)).asTPose();
    EXPECT_NEAR(inverse(pose).x, expected.x, 1e-12);
    EXPECT_NEAR(inverse(pose).y, expected.y, 1e-12);
    EXPECT_NEAR(inverse(pose).phi, expected.phi, 1e-12);
  }
}

TEST(PoseOperations, interpolation_turns_along_the_shorter_arc) {
  const auto middle = interpolate({0, 0, M_PI - 0.1}, {2, 4, -M_PI + 0.3}, 0.5);
  EXPECT_DOUBLE_EQ(middle.x, 1);
  EXPECT_DOUBLE_EQ(middle.y, 2);
  EXPECT_NEAR(middle.phi, -M_PI + 0.1, 1e-12);
}

TEST(PoseOperations, distance_is_that_of_positions) {
  EXPECT_EQ(distance_m(mrpt::math::TPoint2D(1, 2), mrpt::math::TPose2D(4, 6, 3)), 5);
  EXPECT_EQ(distance_m(mrpt::math::TPose2D(4, 6, 3), mrpt::math::TPose2D(1, 2, -1)), 5);
}

}  // namespace
}  // namespace psi_slam
