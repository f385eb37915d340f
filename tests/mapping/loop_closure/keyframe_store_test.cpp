// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/keyframe_store.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <vector>

#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kStep_m = 1.01;  // three steps are longer than a path segment by more than rounding
constexpr PathNoise kPathNoise = {0.02, 0.003, 0.01, 0.015, 0.005};

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

// Front end that drives a path, and the graph of its nodes.
class DrivenPath {
 public:
  explicit DrivenPath(const TPose2D& start) : local_T_robot_(start) { add({}, false); }

  // Adds a node that no local map holds.
  void begin_run() { add({1, 0, 0}, false); }
  void move(const TPose2D& motion, const Eigen::Matrix3d& covariance = Eigen::Matrix3d::Zero()) {
    add(motion, true, covariance);
  }
  Eigen::Matrix3d covariance(std::size_t constraint) const {
    return graph.constraint(constraint).information.inverse();
  }
  Eigen::Matrix3d doubt(std::size_t constraint) const { return graph.constraint(constraint).doubt; }

  KeyframeStore keyframes;
  PoseGraph graph;
  bool matched = true;     // whether the scans of later nodes match
  std::size_t anchor = 0;  // first node of the older local map of later nodes

 private:
  void add(const TPose2D& motion, bool in_local_map,
           const Eigen::Matrix3d& covariance = Eigen::Matrix3d::Zero()) {
    local_T_robot_ = compose(local_T_robot_, motion);
    FrontEndStep step;
    step.local_T_robot = local_T_robot_;
    step.points = std::make_shared<ScanPoints>();
    step.node = graph.add_node({0, 0, 0});  // poses of the graph do not matter
    step.covariance_since_node = covariance;
    step.matched = matched;
    if (in_local_map) step.memberships.push_back({0, anchor, {}, {}});
    remember_node(step, *step.node, keyframes);
    constrain_to_path(step, kPathNoise, keyframes, graph);
  }

  TPose2D local_T_robot_;
};

Eigen::Matrix3d scan_covariance() {
  const double m2 = kPathNoise.scan_sigma_m * kPathNoise.scan_sigma_m;
  return Eigen::Vector3d(m2, m2, kPathNoise.scan_sigma_rad * kPathNoise.scan_sigma_rad).asDiagonal();
}

void expect_pose(const TPose2D& pose, const TPose2D& expected) {
  EXPECT_NEAR(pose.x, expected.x, 1e-9);
  EXPECT_NEAR(pose.y, expected.y, 1e-9);
  EXPECT_NEAR(std::remainder(pose.phi - expected.phi, 2 * M_PI), 0, 1e-9);
}

TEST(ConstrainToPath, hangs_nodes_on_their_segment_and_segments_on_each_other) {
  DrivenPath path({4, -2, 0.7});
  for (int i = 0; i < 8; ++i) path.move({kStep_m, 0, 0});
  ASSERT_EQ(path.graph.num_constraints(), 8U) << "one constraint for each node but the first";
  const std::vector<std::size_t> from = {0, 0, 0, 3, 3, 3, 6, 6};
  const std::vector<std::size_t> segment = {0, 0, 0, 3, 3, 3, 6, 6, 6};
  for (std::size_t i = 0; i < 8; ++i) {
    const Constraint& constraint = path.graph.constraint(i);
    EXPECT_EQ(constraint.kind, Constraint::Kind::kLocalMap);
    EXPECT_EQ(constraint.from, from[i]);
    EXPECT_EQ(constraint.to, i + 1);
    EXPECT_FALSE(constraint.kernel);
    expect_pose(constraint.from_T_to, {kStep_m * static_cast<double>(i + 1 - from[i]), 0, 0});
  }
  for (std::size_t node = 0; node < 9; ++node) EXPECT_EQ(path.keyframes.nodes[node].segment, segment[node]);
}

// Along a straight line, the covariance of the drift is known in closed form.
TEST(ConstrainToPath, states_the_drift_since_the_first_node_of_the_segment) {
  DrivenPath path({4, -2, 0.7});
  for (int i = 0; i < 5; ++i) path.move({kStep_m, 0, 0});
  const double m2 = kPathNoise.sigma_m_per_sqrt_m * kPathNoise.sigma_m_per_sqrt_m * kStep_m;
  const double rad2 = kPathNoise.sigma_rad_per_sqrt_m * kPathNoise.sigma_rad_per_sqrt_m * kStep_m;
  const auto drift = [&](int steps) {
    Eigen::Matrix3d covariance = Eigen::Vector3d(steps * m2, steps * m2, steps * rad2).asDiagonal();
    for (int after = 0; after < steps; ++after) {  // steps after each error of the heading
      const double lever_m = after * kStep_m;
      covariance(1, 1) += lever_m * lever_m * rad2;
      covariance(1, 2) += lever_m * rad2;
      covariance(2, 1) += lever_m * rad2;
    }
    return covariance;
  };
  EXPECT_TRUE(path.covariance(0).isApprox(drift(1) + scan_covariance(), 1e-9));
  EXPECT_TRUE(path.covariance(1).isApprox(drift(2) + scan_covariance(), 1e-9));
  EXPECT_TRUE(path.covariance(2).isApprox(drift(3), 1e-9))
      << "the first node of a segment stands for its whole segment, so the error of its scan does not count";
  EXPECT_TRUE(path.covariance(3).isApprox(drift(1) + scan_covariance(), 1e-9))
      << "the drift of an earlier segment does not count";
  EXPECT_TRUE(path.covariance(4).isApprox(drift(2) + scan_covariance(), 1e-9));
}

TEST(ConstrainToPath, an_error_of_the_heading_moves_later_nodes_across_the_path) {
  DrivenPath path({4, -2, 0.7});
  path.move({0, 1, 0});  // to the left, so an error of the heading to the left moves the next node back
  path.move({0, 1, 0});
  const double rad2 = kPathNoise.sigma_rad_per_sqrt_m * kPathNoise.sigma_rad_per_sqrt_m;
  EXPECT_NEAR(path.covariance(1)(0, 2), -rad2, 1e-6 * rad2);
}

TEST(ConstrainToPath, adds_a_part_of_the_covariance_that_the_front_end_states) {
  Eigen::Matrix3d stated;
  stated << 4e-4, 1e-4, 1e-5, 1e-4, 9e-4, -2e-5, 1e-5, -2e-5, 1e-5;
  DrivenPath path({0, 0, 0});
  DrivenPath without({0, 0, 0});
  path.move({0, 0.5, M_PI / 2});
  path.move({0.5, 0, 0}, stated);
  without.move({0, 0.5, M_PI / 2});
  without.move({0.5, 0, 0});
  Eigen::Matrix3d turned;  // by a right angle to the left, in which the robot stood before its second step
  turned << 9e-4, -1e-4, 2e-5, -1e-4, 4e-4, 1e-5, 2e-5, 1e-5, 1e-5;
  const Eigen::Matrix3d part = kPathNoise.stated_share * kPathNoise.stated_share * turned;
  EXPECT_TRUE((path.covariance(1) - without.covariance(1)).isApprox(part, 1e-6));
  EXPECT_TRUE(path.covariance(0).isApprox(without.covariance(0), 1e-9));
}

TEST(ConstrainToPath, keeps_the_error_of_odometry_where_no_scan_matches) {
  const Eigen::Matrix3d stated = Eigen::Vector3d(4e-2, 9e-2, 1e-2).asDiagonal();
  DrivenPath none({0, 0, 0});
  DrivenPath matched({0, 0, 0});
  DrivenPath unmatched({0, 0, 0});
  unmatched.matched = false;
  none.move({0.3, 0, 0.2});
  for (DrivenPath* one : {&matched, &unmatched}) one->move({0.3, 0, 0.2}, stated);
  EXPECT_TRUE((unmatched.covariance(0) - none.covariance(0)).isApprox(stated, 1e-6));
  // Only the errors of matches may repeat.
  const double more = kPathDoubt * kPathDoubt - 1;
  EXPECT_TRUE(matched.doubt(0).isApprox(more * matched.covariance(0), 1e-6));
  EXPECT_TRUE(unmatched.doubt(0).isApprox(more * none.covariance(0), 1e-6));
}

TEST(ConstrainToPath, a_match_with_an_older_local_map_takes_the_error_of_odometry_back) {
  const Eigen::Matrix3d stated = Eigen::Vector3d(4e-2, 9e-2, 1e-2).asDiagonal();
  DrivenPath always({0, 0, 0});
  DrivenPath same_map({0, 0, 0});
  DrivenPath new_map({0, 0, 0});
  for (DrivenPath* one : {&always, &same_map, &new_map}) {
    one->matched = one == &always;
    one->move({0.3, 0, 0}, stated);
    one->matched = true;
    one->anchor = one == &new_map ? 1 : 0;
    one->move({0.3, 0, 0});
  }
  EXPECT_TRUE(same_map.covariance(1).isApprox(always.covariance(1), 1e-6));
  EXPECT_TRUE(same_map.doubt(1).isApprox(always.doubt(1), 1e-6));
  EXPECT_GT(new_map.covariance(1)(0, 0), stated(0, 0));
}

TEST(ConstrainToPath, does_not_depend_on_the_frame_of_the_front_end) {
  DrivenPath path({0, 0, 0});
  DrivenPath elsewhere({30, -7, 2.5});
  for (DrivenPath* one : {&path, &elsewhere})
    for (int i = 0; i < 12; ++i) one->move({0.4, 0.1, i < 6 ? 0.3 : -0.5});
  ASSERT_EQ(path.graph.num_constraints(), elsewhere.graph.num_constraints());
  for (std::size_t i = 0; i < path.graph.num_constraints(); ++i) {
    EXPECT_EQ(path.graph.constraint(i).from, elsewhere.graph.constraint(i).from);
    expect_pose(path.graph.constraint(i).from_T_to, elsewhere.graph.constraint(i).from_T_to);
    EXPECT_TRUE(path.covariance(i).isApprox(elsewhere.covariance(i), 1e-6)) << i;
  }
}

TEST(ConstrainToPath, drift_grows_with_turns_either_way) {
  for (const double turn_rad : {0.8, -0.8}) {
    DrivenPath path({1, 1, 3});
    path.move({0, 0, turn_rad});
    path.move({0, 0, turn_rad});
    const double per_rad2 = kPathNoise.sigma_rad_per_sqrt_rad * kPathNoise.sigma_rad_per_sqrt_rad;
    const Eigen::Matrix3d drift = path.covariance(1) - scan_covariance();
    EXPECT_NEAR(drift(2, 2), 1.6 * per_rad2, 1e-6 * per_rad2);
    EXPECT_NEAR(drift(0, 0), 0, 1e-12) << "the robot stayed in place";
    EXPECT_EQ(path.keyframes.nodes[2].segment, 0U);
  }
}

TEST(ConstrainToPath, a_node_in_no_local_map_begins_a_run) {
  DrivenPath path({0, 0, 0});
  EXPECT_EQ(path.graph.num_constraints(), 0U);
  path.move({1, 0, 0});
  path.begin_run();
  EXPECT_EQ(path.graph.num_constraints(), 1U);
  EXPECT_EQ(path.keyframes.nodes[2].segment, 2U);
  path.move({1, 0, 0});
  ASSERT_EQ(path.graph.num_constraints(), 2U);
  EXPECT_EQ(path.graph.constraint(1).from, 2U);
  EXPECT_TRUE(path.covariance(1).isApprox(path.covariance(0), 1e-9)) << "drift of one metre";
}

// A path along x with a node each metre, and a local map of its nodes 1 to 7.
class SetReferenceTest : public ::testing::Test {
 protected:
  SetReferenceTest() {
    for (int i = 0; i < 11; ++i) path_.move({1, 0, 0});
    PlacedLocalMap local_map;
    local_map.anchor = local_map.first_node = 1;
    local_map.last_node = 7;
    path_.keyframes.local_maps.push_back(local_map);
  }

  // Returns the loop of a node that is matched with the local map, with this pose relative to node 1.
  LoopRecord matched(std::size_t node, const TPose2D& anchor_T_node) const {
    LoopRecord loop;
    loop.node = node;
    loop.anchor = 1;
    loop.anchor_T_node = anchor_T_node;
    set_reference(loop, path_.keyframes);
    return loop;
  }

  DrivenPath path_{TPose2D(2, 3, 0)};  // so that its length has no rounding
};

TEST_F(SetReferenceTest, is_the_first_node_of_the_segment_nearest_to_the_match) {
  const LoopRecord far = matched(11, {3.6, 0.5, 2});  // beside nodes 4 and 5, nearer to 5
  EXPECT_EQ(far.reference, 3U);
  expect_pose(far.reference_T_node, {1.6, 0.5, 2});
  const LoopRecord end = matched(11, {40, 0, 0});
  EXPECT_EQ(end.reference, 6U);
  expect_pose(end.reference_T_node, {35, 0, 0});
  const LoopRecord near = matched(11, {0.2, -1, -3});
  EXPECT_EQ(near.reference, 0U) << "a segment may begin before the local map";
  expect_pose(near.reference_T_node, {1.2, -1, -3});
}

TEST_F(SetReferenceTest, is_the_nearest_node_itself_within_the_same_segment) {
  const LoopRecord loop = matched(8, {5.7, 0.5, 0.1});
  ASSERT_EQ(path_.keyframes.nodes[8].segment, 6U);
  EXPECT_EQ(loop.reference, 7U);
  expect_pose(loop.reference_T_node, {-0.3, 0.5, 0.1});
}

}  // namespace
}  // namespace psi_slam
