// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/scan_context.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "../local_maps/simulated_drive.h"
#include "mapping/local_maps/scan_filter.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2Df;
using mrpt::math::TPose2D;

NodeScan node_with(const TPose2D& local_T_robot, double travelled_m, const std::vector<TPoint2Df>& points,
                   const std::vector<TPoint2Df>& normals) {
  ScanPoints scan;
  scan.points = points;
  scan.normals = normals;
  NodeScan node;
  node.local_T_robot = local_T_robot;
  node.travelled_m = travelled_m;
  node.points = std::make_shared<const ScanPoints>(scan);
  return node;
}

// A straight path from the pose (3, 4, 0.7). Each node's scan has one point, at (2, 1) in the robot's frame.
KeyframeStore straight_drive(int nodes, double step_m) {
  KeyframeStore keyframes;
  for (int i = 0; i < nodes; ++i)
    keyframes.nodes.push_back(
        node_with(TPose2D(3, 4, 0.7) + TPose2D(i * step_m, 0, 0), i * step_m, {{2, 1}}, {{0, -1}}));
  return keyframes;
}

std::vector<double> sorted_x(const ScanPoints& scan) {
  std::vector<double> result;
  for (const auto& point : scan.points) result.push_back(static_cast<double>(point.x));
  std::sort(result.begin(), result.end());
  return result;
}

void expect_x(const ScanPoints& context, const std::vector<double>& expected) {
  const std::vector<double> found = sorted_x(context);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-5);
  for (const auto& point : context.points) EXPECT_NEAR(point.y, 1, 1e-5);
}

TEST(ScanContext, holds_points_of_earlier_nodes_in_the_frame_of_the_node) {
  ScanContextOptions options;
  options.travel_m = 4.25;
  options.node_spacing_m = 0.75;
  const ScanPoints context = scan_context(20, straight_drive(30, 0.5), options);
  expect_x(context, {-2, -1, 0, 1, 2});  // nodes of the context are one metre apart
  EXPECT_NEAR(context.farthest_m, std::sqrt(5), 1e-5);
}

TEST(ScanContext, nodes_are_as_far_apart_as_the_spacing) {
  ScanContextOptions options;
  options.travel_m = 4.25;
  options.node_spacing_m = 0.25;
  expect_x(scan_context(20, straight_drive(30, 0.5), options), {-2, -1.5, -1, -0.5, 0, 0.5, 1, 1.5, 2});
  options.node_spacing_m = 1.25;
  expect_x(scan_context(20, straight_drive(30, 0.5), options), {-1, 0.5, 2});
}

TEST(ScanContext, ends_after_the_travel) {
  ScanContextOptions options;
  options.node_spacing_m = 0.75;
  options.travel_m = 2.25;
  expect_x(scan_context(20, straight_drive(30, 0.5), options), {0, 1, 2});
  options.travel_m = 0;
  expect_x(scan_context(20, straight_drive(30, 0.5), options), {2});
}

TEST(ScanContext, of_an_early_node_is_shorter) {
  expect_x(scan_context(0, straight_drive(30, 0.5), {}), {2});
  expect_x(scan_context(2, straight_drive(30, 0.5), {}), {1, 2});
}

TEST(ScanContext, a_point_seen_several_times_counts_once) {
  KeyframeStore keyframes;
  for (int i = 0; i < 5; ++i) {  // all nodes see the points (5.53, 1.53) and (5.53, 1.75)
    const float x = 5.53F - static_cast<float>(i);
    keyframes.nodes.push_back(node_with({1.0 * i, 0, 0}, i, {{x, 1.53F}, {x, 1.75F}}, {{0, -1}, {0, -1}}));
  }
  ScanContextOptions options;
  options.node_spacing_m = 0.75;
  options.point_spacing_m = 0.1;
  EXPECT_EQ(scan_context(4, keyframes, options).points.size(), 2U);
  options.point_spacing_m = 1;  // seen from x = 4, both points lie in the square from (1, 1) to (2, 2)
  EXPECT_EQ(scan_context(4, keyframes, options).points.size(), 1U);
}

TEST(ScanContext, points_and_normals_turn_with_the_robot) {
  KeyframeStore keyframes;
  keyframes.nodes.push_back(node_with({0, 0, 0}, 0, {{2, 1}}, {{0, -1}}));
  keyframes.nodes.push_back(node_with({1, 0, M_PI / 2}, 1, {{3, 3}}, {{0.6F, 0.8F}}));
  const ScanPoints context = scan_context(1, keyframes, {});
  ASSERT_EQ(context.points.size(), 2U);
  ASSERT_EQ(context.normals.size(), 2U);
  EXPECT_EQ(context.points[0].x, 3);
  EXPECT_EQ(context.points[0].y, 3);
  EXPECT_NEAR(context.normals[0].x, 0.6, 1e-6);
  EXPECT_NEAR(context.normals[0].y, 0.8, 1e-6);
  EXPECT_NEAR(context.points[1].x, 1, 1e-6);
  EXPECT_NEAR(context.points[1].y, -1, 1e-6);
  EXPECT_NEAR(context.normals[1].x, -1, 1e-6);
  EXPECT_NEAR(context.normals[1].y, 0, 1e-6);
  EXPECT_NEAR(context.farthest_m, std::sqrt(18), 1e-5);
}

TEST(ScanContext, lies_on_the_walls_and_extends_along_the_past_path) {
  const SimulatedWalls floor = office_floor();
  const BeamBearings bearings = even_bearings(-M_PI / 2, M_PI / 2, 181);
  std::mt19937_64 random(3);
  KeyframeStore keyframes;
  double travelled_m = 0;
  TPose2D before(0, 0, 0);
  std::vector<TPose2D> truth;
  const TPose2D local_T_world(-2, 5, 1);
  for (const TPose2D& pose : path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 6}}, 0.25, 0.2)) {
    if (!truth.empty()) travelled_m += std::hypot(pose.x - before.x, pose.y - before.y);
    before = pose;
    truth.push_back(pose);
    NodeScan node;
    node.local_T_robot = local_T_world + pose;
    node.travelled_m = travelled_m;
    node.points = std::make_shared<const ScanPoints>(
        matching_points(simulated_scan(floor, pose, bearings, {0.2, 0.1, 0}, 0.005, random), {}));
    keyframes.nodes.push_back(node);
  }
  const std::size_t last = keyframes.nodes.size() - 1;
  const ScanPoints context = scan_context(last, keyframes, {});
  EXPECT_EQ(context.origin, keyframes.nodes[last].points->origin);
  EXPECT_EQ(context.normals.size(), context.points.size());
  EXPECT_GT(context.points.size(), keyframes.nodes[last].points->points.size());
  int behind = 0;
  for (const auto& point : context.points) {
    const TPose2D at = truth[last] + TPose2D(static_cast<double>(point.x), static_cast<double>(point.y), 0);
    EXPECT_LT(floor.distance_m(at.x, at.y), 0.05);
    EXPECT_LE(std::hypot(point.x, point.y), context.farthest_m + 1e-4);
    if (point.x < -1) ++behind;
  }
  EXPECT_GT(behind, 50);
}

TEST(ScanContext, keeps_at_most_the_largest_number_of_points_evenly) {
  ScanContextOptions options;
  options.travel_m = 100;
  const KeyframeStore keyframes = straight_drive(60, 1.0);
  const ScanPoints all = scan_context(59, keyframes, options);
  ASSERT_EQ(all.points.size(), 60U);
  options.max_points = 60;
  EXPECT_EQ(scan_context(59, keyframes, options).points.size(), 60U);
  options.max_points = 25;
  const ScanPoints some = scan_context(59, keyframes, options);
  ASSERT_EQ(some.points.size(), 25U);
  ASSERT_EQ(some.normals.size(), 25U);
  EXPECT_EQ(some.points.front(), all.points.front());
  for (std::size_t i = 1; i < some.points.size(); ++i) {
    const double step = std::abs(double{some.points[i].x} - double{some.points[i - 1].x});
    EXPECT_GT(step, 1.5);
    EXPECT_LT(step, 3.5);
  }
  EXPECT_LT(some.farthest_m, all.farthest_m + 1e-9);
  for (const auto& point : some.points)
    EXPECT_LE(std::hypot(double{point.x}, double{point.y}), some.farthest_m + 1e-9);
}

}  // namespace
}  // namespace psi_slam
