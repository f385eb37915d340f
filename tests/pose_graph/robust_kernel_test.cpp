// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/robust_kernel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

using Type = RobustKernel::Type;

class EveryRobustKernel : public testing::TestWithParam<Type> {};
INSTANTIATE_TEST_SUITE_P(Types, EveryRobustKernel,
                         testing::Values(Type::kNone, Type::kHuber, Type::kCauchy, Type::kDynamicScaling,
                                         Type::kGemanMcClure));

TEST_P(EveryRobustKernel, has_the_derivative_of_its_cost_as_weight) {
  for (const double width : {0.5, 1.0, 3.0}) {
    const RobustKernel kernel{GetParam(), width};
    for (double chi2 = 0.01; chi2 < 1e5; chi2 *= 1.37) {
      const double step = 1e-6 * chi2;
      const double numeric = (kernel.cost(chi2 + step) - kernel.cost(chi2 - step)) / (2 * step);
      EXPECT_NEAR(kernel.weight(chi2), numeric, 1e-6 + 1e-6 * numeric) << width << " " << chi2;
    }
  }
}

TEST_P(EveryRobustKernel, leaves_small_errors_alone_and_never_adds_to_an_error) {
  const RobustKernel kernel{GetParam(), 2};
  EXPECT_EQ(kernel.cost(0), 0);
  EXPECT_EQ(kernel.weight(0), 1);
  EXPECT_NEAR(kernel.cost(1e-4), 1e-4, 1e-8);
  double last_cost = 0;
  double last_weight = 1;
  for (double chi2 = 1e-3; chi2 < 1e12; chi2 *= 1.5) {
    EXPECT_LE(kernel.cost(chi2), chi2);
    EXPECT_GE(kernel.cost(chi2), last_cost);
    EXPECT_GE(kernel.weight(chi2), 0);
    EXPECT_LE(kernel.weight(chi2), last_weight);
    last_cost = kernel.cost(chi2);
    last_weight = kernel.weight(chi2);
  }
}

TEST(RobustKernel, bounds_the_cost_of_the_redescending_ones) {
  EXPECT_NEAR((RobustKernel{Type::kGemanMcClure, 3}.cost(1e12)), 9, 1e-6);
  EXPECT_NEAR((RobustKernel{Type::kDynamicScaling, 3}.cost(1e12)), 27, 1e-6);
}

TEST(RobustKernel, scales_as_dynamic_covariance_scaling_does) {
  constexpr double kPhi = 2.5;
  const RobustKernel kernel{Type::kDynamicScaling, std::sqrt(kPhi)};
  for (const double chi2 : {0.1, 2.4, 2.6, 10.0, 1000.0}) {
    const double s = std::min(1.0, 2 * kPhi / (kPhi + chi2));  // equation 15 of the paper
    EXPECT_NEAR(kernel.weight(chi2), s * s, 1e-12);
  }
}

}  // namespace
}  // namespace psi_slam
