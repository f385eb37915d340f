// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/pose_graph.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "psi_slam/user_error.h"
#include "test_graphs.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;

Constraint link(std::size_t from, std::size_t to) {
  Constraint constraint;
  constraint.from = from;
  constraint.to = to;
  return constraint;
}

TEST(PoseGraph, numbers_nodes_and_constraints_in_their_order) {
  PoseGraph graph;
  EXPECT_EQ(graph.add_node({0, 0, 0}), 0U);
  EXPECT_EQ(graph.add_node({1, 0, 0}), 1U);
  EXPECT_EQ(graph.add_node({2, 0, 0}), 2U);
  EXPECT_EQ(graph.add_constraint(link(0, 1)), 0U);
  EXPECT_EQ(graph.add_constraint(link(2, 1)), 1U);
  EXPECT_EQ(graph.num_nodes(), 3U);
  EXPECT_EQ(graph.num_constraints(), 2U);
  EXPECT_THAT(graph.constraints_of(1), ElementsAre(0, 1));
  EXPECT_THAT(graph.constraints_of(2), ElementsAre(1));
  EXPECT_EQ(graph.root(), 0U);
}

TEST(PoseGraph, wraps_headings) {
  PoseGraph graph;
  graph.add_node({0, 0, 3 * M_PI});
  graph.add_node({0, 0, 0});
  EXPECT_EQ(graph.pose(0).phi, M_PI);
  graph.set_pose(1, {0, 0, -M_PI});
  EXPECT_EQ(graph.pose(1).phi, M_PI);
  Constraint turn = link(0, 1);
  turn.from_T_to.phi = 7;
  graph.add_constraint(turn);
  EXPECT_NEAR(graph.constraint(0).from_T_to.phi, 7 - 2 * M_PI, 1e-15);
}

TEST(PoseGraph, rejects_unknown_nodes_and_invalid_measurements) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  PoseGraph graph;
  EXPECT_THROW(graph.add_node({kNaN, 0, 0}), std::invalid_argument);
  graph.add_node({0, 0, 0});
  graph.add_node({1, 0, 0});
  EXPECT_THROW(graph.set_pose(1, {0, 0, kNaN}), std::invalid_argument);
  EXPECT_THROW(graph.set_pose(2, {0, 0, 0}), std::out_of_range);
  EXPECT_THROW(graph.add_constraint(link(0, 2)), std::out_of_range);
  EXPECT_THROW(graph.add_constraint(link(1, 1)), std::invalid_argument);
  Constraint bad = link(0, 1);
  bad.from_T_to.x = kNaN;
  EXPECT_THROW(graph.add_constraint(bad), std::invalid_argument);
  bad = link(0, 1);
  bad.information(1, 1) = -1;
  EXPECT_THROW(graph.add_constraint(bad), std::invalid_argument);
  EXPECT_THROW(graph.set_root(2), std::out_of_range);
  EXPECT_EQ(graph.num_constraints(), 0U);
}

TEST(PoseGraph, leaves_disabled_constraints_out_of_chi2) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({1, 0, 0});
  graph.add_constraint(link(0, 1));
  graph.add_constraint(link(1, 0));
  EXPECT_EQ(graph.chi2(), 2);
  graph.set_enabled(1, false);
  EXPECT_FALSE(graph.enabled(1));
  EXPECT_EQ(graph.chi2(), 1);
  graph.set_enabled(1, true);
  EXPECT_EQ(graph.chi2(), 2);
}

TEST(PoseGraph, packs_the_covariance_of_each_constraint) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({1, 0, 0});
  Constraint constraint = link(1, 0);
  Eigen::Matrix3d covariance;
  covariance << 4e-4, 1e-4, 2e-6, 1e-4, 9e-4, -3e-6, 2e-6, -3e-6, 1e-6;
  constraint.information = covariance.inverse();
  constraint.information = (0.5 * (constraint.information + constraint.information.transpose())).eval();
  constraint.doubt << 0.5, 0, 0, 0, 1, 0.25, 0, 0.25, 1;
  graph.add_constraint(constraint);
  const GraphLink& packed = graph.links()[0];
  EXPECT_EQ(packed.from, 1U);
  EXPECT_EQ(packed.to, 0U);
  EXPECT_NEAR(packed.covariance.xx, 4e-4, 1e-15);
  EXPECT_NEAR(packed.covariance.xy, 1e-4, 1e-15);
  EXPECT_NEAR(packed.covariance.xt, 2e-6, 1e-15);
  EXPECT_NEAR(packed.covariance.yy, 9e-4, 1e-15);
  EXPECT_NEAR(packed.covariance.yt, -3e-6, 1e-15);
  EXPECT_NEAR(packed.covariance.tt, 1e-6, 1e-15);
  EXPECT_EQ(packed.doubt.xx, 0.5);
  EXPECT_EQ(packed.doubt.yt, 0.25);

  constraint.information = Eigen::Vector3d(1, 1, 0).asDiagonal();
  graph.add_constraint(constraint);
  EXPECT_EQ(graph.links()[1].covariance.tt, std::numeric_limits<double>::infinity());
}

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

TEST_P(EveryRobustKernel, keeps_small_errors_and_never_increases_an_error) {
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
