// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/transform_tree.h"

#include <gmock/gmock.h>

#include <cmath>

namespace psi_slam {
namespace {

using testing::ElementsAre;

RosTransform transform(const std::string& parent, const std::string& child,
                       const mrpt::math::TPose3D& pose = {}) {
  RosTransform transform;
  transform.header.frame = parent;
  transform.child_frame = child;
  transform.pose = mrpt::poses::CPose3D(pose);
  return transform;
}

/// map < odom < base_link, with a laser on a mast that looks backwards, and a wheel.
TransformTree robot() {
  TransformTree tree;
  tree.add(transform("map", "odom"));
  tree.add(transform("odom", "base_link", {5, 0, 0, 0, 0, 0}));
  tree.add(transform("base_link", "mast", {0.5, 0, 1, M_PI, 0, 0}));
  tree.add(transform("mast", "laser", {0.1, 0, 0, 0, 0, 0}));
  tree.add(transform("base_link", "wheel", {0, 0.2, 0, 0, 0, 0}));
  return tree;
}

TEST(TransformTree, finds_the_frames_above_a_frame) {
  EXPECT_THAT(robot().way_up("laser"), ElementsAre("laser", "mast", "base_link", "odom", "map"));
  EXPECT_THAT(robot().way_up("unknown"), ElementsAre("unknown"));
  EXPECT_EQ(robot().parent_of("laser"), "mast");
  EXPECT_EQ(robot().parent_of("map"), "");
}

TEST(TransformTree, ends_ways_in_a_cycle) {
  TransformTree tree;
  tree.add(transform("a", "b"));
  tree.add(transform("b", "a"));
  tree.add(transform("c", "c"));
  EXPECT_LE(tree.way_up("a").size(), 3U);
  EXPECT_THAT(tree.way_up("c"), ElementsAre("c")) << "a frame is not above itself";
}

TEST(TransformTree, combines_the_poses_between_two_frames) {
  const auto base_T_laser = robot().base_T_frame("base_link", "laser");
  ASSERT_TRUE(base_T_laser);
  EXPECT_NEAR(base_T_laser->x(), 0.4, 1e-12);
  EXPECT_NEAR(base_T_laser->z(), 1, 1e-12);
  EXPECT_NEAR(std::abs(base_T_laser->yaw()), M_PI, 1e-12);
  const auto wheel_T_laser = robot().base_T_frame("wheel", "laser");
  ASSERT_TRUE(wheel_T_laser) << "the two meet at base_link";
  EXPECT_NEAR(wheel_T_laser->y(), -0.2, 1e-12);
  EXPECT_FALSE(robot().base_T_frame("base_link", "camera"));
}

TEST(TransformTree, keeps_the_last_pose) {
  TransformTree tree = robot();
  tree.add(transform("odom", "base_link", {7, 0, 0, 0, 0, 0}));
  EXPECT_NEAR(tree.base_T_frame("odom", "base_link")->x(), 7, 1e-12);
}

TEST(TransformTree, prefers_children_that_are_named_like_a_base) {
  TransformTree tree;
  tree.add(transform("odom", "a_camera"));
  tree.add(transform("odom", "robot/Base_link"));
  const auto is_odom = [](const std::string& parent) { return parent == "odom"; };
  EXPECT_EQ(tree.child_of(is_odom), "robot/Base_link");
  EXPECT_EQ(tree.child_of([](const std::string&) { return false; }), std::nullopt);
  EXPECT_TRUE(has_word("robot/Base_link", "base"));
  EXPECT_FALSE(has_word("base_1/laser", "base")) << "only the last part counts";
  EXPECT_EQ(tree.text(), "a_camera < odom, robot/Base_link < odom");
  EXPECT_EQ(TransformTree().text(), "none");
}

}  // namespace
}  // namespace psi_slam
