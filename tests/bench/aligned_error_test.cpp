// SPDX-License-Identifier: BSD-3-Clause
#include "common/aligned_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

TEST(AlignedError, ignores_rigid_motions_and_measures_the_rest) {
  std::vector<TPose2D> truth;
  std::vector<TPose2D> path;
  for (int i = 0; i < 50; ++i) {
    truth.emplace_back(0.1 * i, std::sin(0.2 * i), 0);
    path.push_back(TPose2D(3, -2, 0.7) + truth.back());
  }
  EXPECT_NEAR(aligned_error_m(path, truth), 0, 1e-9);
  for (std::size_t i = 0; i < path.size(); ++i) path[i].x += i % 2 == 0 ? 0.1 : -0.1;
  EXPECT_NEAR(aligned_error_m(path, truth), 0.1, 0.01);
}

}  // namespace
}  // namespace psi_slam
