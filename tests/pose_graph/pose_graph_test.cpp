// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/pose_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
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
  graph.add_node({0, 0, 3 * kPi});
  graph.add_node({0, 0, 0});
  EXPECT_EQ(graph.pose(0).phi, kPi);
  graph.set_pose(1, {0, 0, -kPi});
  EXPECT_EQ(graph.pose(1).phi, kPi);
  Constraint turn = link(0, 1);
  turn.from_T_to.phi = 7;
  graph.add_constraint(turn);
  EXPECT_NEAR(graph.constraint(0).from_T_to.phi, 7 - 2 * kPi, 1e-15);
}

TEST(PoseGraph, refuses_what_does_not_exist_or_is_no_measurement) {
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
  graph.add_constraint(constraint);
  const GraphLink& packed = graph.links()[0];
  EXPECT_EQ(packed.from, 1U);
  EXPECT_EQ(packed.to, 0U);
  EXPECT_NEAR(packed.xx, 4e-4, 1e-15);
  EXPECT_NEAR(packed.xy, 1e-4, 1e-15);
  EXPECT_NEAR(packed.xt, 2e-6, 1e-15);
  EXPECT_NEAR(packed.yy, 9e-4, 1e-15);
  EXPECT_NEAR(packed.yt, -3e-6, 1e-15);
  EXPECT_NEAR(packed.tt, 1e-6, 1e-15);

  constraint.information = Eigen::Vector3d(1, 1, 0).asDiagonal();
  graph.add_constraint(constraint);
  EXPECT_EQ(graph.links()[1].tt, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace psi_slam
