// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/loop_residuals.h"

#include <gtest/gtest.h>

#include "two_passes.h"

namespace psi_slam {
namespace {

TEST(LoopResiduals, put_the_loop_that_the_map_contradicts_first) {
  MappingResult result = two_passes();
  result.loops = {loop_between(result, 2, 42), loop_between(result, 3, 43, {0.5, 0, 0.1}),
                  loop_between(result, 4, 44, {5, 0, 0})};
  reject(result.loops[2], {LoopRejection::Reason::kContradicted});
  const std::vector<LoopResidual> residuals = loop_residuals(result);
  ASSERT_EQ(residuals.size(), 2U) << "accepted loops only";
  EXPECT_EQ(residuals[0].loop, 1U);
  EXPECT_NEAR(residuals[0].residual_m, 0.5, 1e-9);
  EXPECT_NEAR(residuals[0].residual_rad, 0.1, 1e-9);
  EXPECT_GT(residuals[0].chi, 8);
  EXPECT_NEAR(residuals[1].chi, 0, 1e-6);
}

}  // namespace
}  // namespace psi_slam
