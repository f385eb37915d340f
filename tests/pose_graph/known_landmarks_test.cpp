// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/known_landmarks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pose_graph/placed_covariances.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kDriveStep_m = 0.5;
constexpr std::size_t kDriveNodes = 81;
constexpr double kDegree = M_PI / 180;
constexpr double kMaxChi = 5;

// The robot drives along a straight line in the site. Every step is measured 2 % too short, and its standard
// deviation is 2 cm.
PoseGraph short_drive() {
  PoseGraph graph;
  for (std::size_t i = 0; i < kDriveNodes; ++i)
    graph.add_node({0.98 * kDriveStep_m * static_cast<double>(i), 0, 0});
  for (std::size_t i = 1; i < kDriveNodes; ++i) {
    Constraint step;
    step.from = i - 1;
    step.to = i;
    step.from_T_to = graph.pose(i) - graph.pose(i - 1);
    step.information = Eigen::Vector3d(2500, 2500, 1e6).asDiagonal();
    graph.add_constraint(step);
  }
  return graph;
}

// True pose of a node. The site is turned by 90 degrees, and its coordinates are large.
TPose2D site_T_node(std::size_t node) {
  return {500'000, 4'000'000 + kDriveStep_m * static_cast<double>(node), 90 * kDegree};
}

Landmark known_pose(std::size_t node, const TPose2D& site_T_robot) {
  return {MeasuredPose{site_T_robot, 0.02, 1 * kDegree}, {{node, {{0, 0, 0}, 1e-3, 0.01 * kDegree}}}};
}

Landmark known_position(std::size_t node) {
  Landmark landmark = known_pose(node, site_T_node(node));
  landmark.site_T_mark->sigma_rad.reset();
  return landmark;
}

double farthest_m(const PoseGraph& graph) {
  double farthest = 0;
  for (std::size_t i = 0; i < kDriveNodes; ++i)
    farthest = std::max(farthest,
                        std::hypot(graph.pose(i).x - site_T_node(i).x, graph.pose(i).y - site_T_node(i).y));
  return farthest;
}

KnownLandmarks settled(const std::vector<Landmark>& landmarks, PoseGraph& graph) {
  KnownLandmarks known(landmarks, graph);
  known.select(graph, kMaxChi);
  SparsePoseAdjustment().optimize(graph);
  known.move_to_site(graph);
  return known;
}

TEST(KnownLandmarks, two_poses_correct_the_scale) {
  PoseGraph graph = short_drive();
  settled({known_pose(0, site_T_node(0)), known_pose(80, site_T_node(80))}, graph);
  EXPECT_LT(farthest_m(graph), 0.05) << "0.8 m without the second pose";
  EXPECT_EQ(graph.pose(graph.root()).x, 500'000) << "the root is a point of the site";
}

TEST(KnownLandmarks, a_further_covariance_makes_a_pose_weak_along_one_axis) {
  PoseGraph graph = short_drive();
  Landmark weak = known_pose(80, site_T_node(80));
  weak.site_T_mark->further(1, 1) = 25;  // along the way
  settled({known_pose(0, site_T_node(0)), weak}, graph);
  EXPECT_NEAR(graph.pose(80).x, site_T_node(80).x, 0.05);
  EXPECT_GT(std::abs(graph.pose(80).y - site_T_node(80).y), 0.6) << "0.02 m without the weakness";
}

TEST(KnownLandmarks, positions_alone_turn_the_map_into_the_site) {
  PoseGraph graph = short_drive();
  settled({known_position(5), known_position(40), known_position(76)}, graph);
  EXPECT_LT(farthest_m(graph), 0.06);
}

TEST(KnownLandmarks, a_wrong_pose_is_switched_off) {
  const std::vector<Landmark> right{known_pose(0, site_T_node(0)), known_pose(40, site_T_node(40)),
                                    known_pose(80, site_T_node(80))};
  PoseGraph without = short_drive();
  settled(right, without);

  std::vector<Landmark> wrong = right;
  wrong.insert(wrong.begin() + 1, known_pose(20, site_T_node(30)));  // 5 m off
  PoseGraph with = short_drive();
  const KnownLandmarks known = settled(wrong, with);
  EXPECT_FALSE(known.uses_place(1, with));
  for (const std::size_t i : {0U, 2U, 3U}) EXPECT_TRUE(known.uses_place(i, with)) << i;
  EXPECT_NEAR(known.place_residual(1, with).distance_m, 5, 0.1);
  for (std::size_t i = 0; i < kDriveNodes; ++i) {
    EXPECT_NEAR(with.pose(i).x, without.pose(i).x, 1e-4);
    EXPECT_NEAR(with.pose(i).y, without.pose(i).y, 1e-4);
  }
}

TEST(KnownLandmarks, a_tag_of_unknown_place_closes_a_loop) {
  PoseGraph graph = short_drive();
  const TPose2D end = graph.pose(80);
  // The tag is 1 m ahead of node 0, and node 80 sees it 40.8 m behind: the way was 1 m shorter.
  Landmark tag{{}, {{0, {{1, 0, 0}, 0.02, {}}}, {80, {{1.8 - end.x, 0, 0}, 0.02, {}}}}};
  KnownLandmarks known({tag}, graph);
  known.select(graph, kMaxChi);
  SparsePoseAdjustment().optimize(graph);
  known.move_to_site(graph);
  EXPECT_EQ(graph.root(), 0U) << "no place is known, so the map keeps its frame";
  EXPECT_NEAR(graph.pose(80).x, end.x - 0.8, 0.05);
}

TEST(KnownLandmarks, a_wrong_sighting_is_switched_off) {
  PoseGraph graph = short_drive();
  const auto sighting = [&](std::size_t node, double off_m) {
    return LandmarkSighting{node, {{10 - graph.pose(node).x + off_m, 2, 0}, 0.05, {}}};
  };
  KnownLandmarks known({{{}, {sighting(10, 0), sighting(15, 0), sighting(20, 3), sighting(25, 0)}}}, graph);
  known.select(graph, kMaxChi);
  for (const std::size_t k : {0U, 1U, 3U}) EXPECT_TRUE(known.uses_sighting(0, k, graph)) << k;
  EXPECT_FALSE(known.uses_sighting(0, 2, graph));
  EXPECT_NEAR(known.sighting_residual(0, 2, graph).distance_m, 3, 0.1);
}

TEST(KnownLandmarks, covariances_are_relative_to_the_site) {
  PoseGraph graph = short_drive();
  settled({known_pose(0, site_T_node(0)), known_pose(80, site_T_node(80))}, graph);
  const auto covariances = placed_covariances(graph);
  ASSERT_TRUE(covariances[0] && covariances[40] && covariances[80]);
  EXPECT_NEAR(std::sqrt((*covariances[0])(1, 1)), 0.02, 0.005) << "the error of the stated pose";
  EXPECT_GT((*covariances[40])(1, 1), (*covariances[80])(1, 1)) << "between the stated poses";
}

TEST(KnownLandmarks, a_graph_without_knowledge_stays_connected_when_all_is_switched_off) {
  PoseGraph graph = short_drive();
  const std::vector<TPose2D> before = graph.poses();
  KnownLandmarks known({known_pose(0, site_T_node(0)), known_pose(80, site_T_node(0))}, graph);
  known.switch_off(graph);
  SparsePoseAdjustment().optimize(graph);
  for (std::size_t i = 0; i < kDriveNodes; ++i) EXPECT_NEAR(graph.pose(i).x, before[i].x, 1e-6);
}

}  // namespace
}  // namespace psi_slam
