// SPDX-License-Identifier: BSD-3-Clause
#include "frames/inverse_pose.h"

#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>

namespace psi_slam {
namespace {

TEST(InversePose, is_that_of_mrpts_matrices) {
  for (const mrpt::math::TPose2D& pose :
       {mrpt::math::TPose2D(3, -2, 0.7), mrpt::math::TPose2D(0, 5, -3.1), mrpt::math::TPose2D(0, 0, 0)}) {
    const mrpt::math::TPose2D expected = (-mrpt::poses::CPose2D(pose)).asTPose();
    EXPECT_NEAR(inverse(pose).x, expected.x, 1e-12);
    EXPECT_NEAR(inverse(pose).y, expected.y, 1e-12);
    EXPECT_NEAR(inverse(pose).phi, expected.phi, 1e-12);
  }
}

}  // namespace
}  // namespace psi_slam
