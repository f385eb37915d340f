// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/keyframe_store.h"

#include <gtest/gtest.h>

#include <vector>

namespace psi_slam {
namespace {

std::vector<std::size_t> first_of_stretches(const std::vector<double>& travelled_m, double stretch_m) {
  std::vector<NodeScan> nodes(travelled_m.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].travelled_m = travelled_m[i];
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (begins_stretch(i, nodes, stretch_m)) first.push_back(i);
  return first;
}

FrontEndStep step_at(double x_m, double y_m) {
  FrontEndStep step;
  step.local_T_robot = {x_m, y_m, 0.5};
  step.points = std::make_shared<ScanPoints>();
  return step;
}

TEST(RememberNode, keeps_the_scan_and_sums_up_the_path_length) {
  KeyframeStore keyframes;
  remember_node(step_at(1, 1), 4, keyframes);
  remember_node(step_at(4, 5), 7, keyframes);
  const FrontEndStep last = step_at(4, 3);
  remember_node(last, 9, keyframes);
  ASSERT_EQ(keyframes.nodes.size(), 3u);
  EXPECT_EQ(keyframes.nodes[0].travelled_m, 0);
  EXPECT_DOUBLE_EQ(keyframes.nodes[1].travelled_m, 5);
  EXPECT_DOUBLE_EQ(keyframes.nodes[2].travelled_m, 7);
  EXPECT_EQ(keyframes.nodes[2].frame, 9u);
  EXPECT_EQ(keyframes.nodes[2].local_T_robot, last.local_T_robot);
  EXPECT_EQ(keyframes.nodes[2].points, last.points);
}

TEST(TravelAndTurn, sums_distance_and_turn_either_way) {
  const mrpt::math::TPose2D from(1, 2, 3);
  EXPECT_NEAR(travel_and_turn_m(from, {1.3, 2.4, 3}), 0.5, 1e-12);
  EXPECT_NEAR(travel_and_turn_m(from, {1, 2, 3 - 2 * M_PI - 0.2}), 0.2 * kTravelOfTurn_m, 1e-12);
  EXPECT_NEAR(travel_and_turn_m({1.3, 2.4, 2.8}, from), 0.5 + 0.2 * kTravelOfTurn_m, 1e-12);
}

TEST(BeginsStretch, once_in_each_stretch) {
  EXPECT_EQ(first_of_stretches({0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.1}, 0.5), (std::vector<std::size_t>{0, 3, 5}));
}

TEST(BeginsStretch, all_nodes_when_they_are_farther_apart) {
  EXPECT_EQ(first_of_stretches({0, 0.7, 1.2, 3.1}, 0.5), (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(BeginsStretch, all_nodes_when_stretches_have_no_length) {
  EXPECT_EQ(first_of_stretches({0, 0, 0.1}, 0), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(BeginsStretch, once_while_the_robot_turns_on_the_spot) {
  EXPECT_EQ(first_of_stretches({0, 0.6, 0.6, 0.6, 0.6}, 0.5), (std::vector<std::size_t>{0, 1}));
}

TEST(ConstrainToLocalMaps, constrains_the_node_to_each_anchor_with_added_noise) {
  PoseGraph graph;
  for (const double x_m : {0.0, 1.0, 2.0}) graph.add_node({x_m, 0, 0});
  FrontEndStep step;
  step.node = 2;
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.03 * 0.03, 0.03 * 0.03, 0).asDiagonal();
  step.memberships = {{5, 0, {2.1, 0, 0}, covariance}, {6, 1, {1.2, 0, 0}, covariance}};
  constrain_to_local_maps(step, {0.04, 0.1}, graph);

  ASSERT_EQ(graph.num_constraints(), 2u);
  const Constraint& older = graph.constraint(0);
  EXPECT_EQ(older.kind, Constraint::Kind::kLocalMap);
  EXPECT_EQ(older.from, 0u);
  EXPECT_EQ(older.to, 2u);
  EXPECT_EQ(older.from_T_to, (mrpt::math::TPose2D{2.1, 0, 0}));
  EXPECT_EQ(graph.constraint(1).from, 1u);
  const Eigen::Matrix3d expected = Eigen::Vector3d(400, 400, 100).asDiagonal();
  EXPECT_TRUE(older.information.isApprox(expected, 1e-9)) << older.information;
}

TEST(ConstrainToLocalMaps, adds_nothing_for_a_scan_in_no_local_map) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  FrontEndStep step;
  step.node = 0;
  constrain_to_local_maps(step, {0.04, 0.1}, graph);
  EXPECT_EQ(graph.num_constraints(), 0u);
}

}  // namespace
}  // namespace psi_slam
