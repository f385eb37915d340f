// SPDX-License-Identifier: BSD-3-Clause
#include "common/aligned_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

TEST(AlignedError, does_not_mirror_paths) {
  const std::vector<TPose2D> truth = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}};
  std::vector<TPose2D> mirrored = truth;
  for (TPose2D& pose : mirrored) pose.y = -pose.y;
  EXPECT_GT(aligned_error_m(mirrored, truth), 0.1);
}

TEST(AlignedError, aligns_lines_and_single_poses) {
  EXPECT_NEAR(aligned_error_m({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{5, 5, 0}, {6, 5, 0}, {7, 5, 0}}), 0, 1e-9);
  EXPECT_NEAR(aligned_error_m({{1, 2, 3}}, {{5, 5, 0}}), 0, 1e-9);
}

}  // namespace
}  // namespace psi_slam
