// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/tracked_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mapping/local_maps/scan_filter.h"
#include "simulated_drive.h"

namespace psi_slam {
namespace {

constexpr double kFar_m = 12;  // farther ahead, beams hit the walls of the corridor more than 1.5 m apart

ScanPoints scan_of(const SimulatedWalls& walls, double noise_m) {
  std::mt19937_64 random(3);
  const BeamBearings bearings = even_bearings(-M_PI / 2, M_PI / 2, 181);
  return matching_points(simulated_scan(walls, {0, 0, 0}, bearings, {}, noise_m, random), {});
}

ScanPoints scan_of_corridor(double noise_m) {
  SimulatedWalls corridor;
  corridor.add_wall(-60, -1.2, 60, -1.2);
  corridor.add_wall(-60, 1.2, 60, 1.2);
  return scan_of(corridor, noise_m);
}

bool is_set(const mrpt::math::TPoint2Df& normal) {
  return normal.x != 0.0F || normal.y != 0.0F;
}

TEST(TrackedPoints, far_points_of_a_corridor_get_the_normals_of_its_walls) {
  const ScanPoints scan = scan_of_corridor(0.01);
  const TrackedPoints tracked = points_along_walls(scan);
  int far = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (static_cast<double>(scan.points[i].x) < kFar_m) continue;
    ++far;
    EXPECT_FALSE(is_set(scan.normals[i])) << "point " << i;
    EXPECT_NEAR(std::abs(tracked.matched.normals[i].y), 1, 1e-3) << "point " << i;
  }
  EXPECT_GE(far, 6);
  EXPECT_EQ(tracked.matched.points, scan.points);
  const auto is_far = [](const auto& point) { return static_cast<double>(point.x) >= kFar_m; };
  EXPECT_EQ(std::count_if(tracked.judged.points.begin(), tracked.judged.points.end(), is_far), 0);
  EXPECT_GT(tracked.judged.points.size(), scan.points.size() / 2);
}

// The slope of the score of a point that lies off its wall by y is about -y times its normal. It must not
// pull along the wall in one direction.
TEST(TrackedPoints, points_off_a_wall_do_not_pull_along_the_wall) {
  SimulatedWalls wall;
  wall.add_wall(-60, 1.2, 60, 1.2);
  double pull = 0;
  double pull_of_own_normals = 0;
  std::mt19937_64 random(5);
  const BeamBearings bearings = even_bearings(0.2, 0.6, 24);
  for (int trial = 0; trial < 300; ++trial) {
    const ScanPoints scan = matching_points(simulated_scan(wall, {0, 0, 0}, bearings, {}, 0.01, random), {});
    const TrackedPoints tracked = points_along_walls(scan);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const auto slope_along = [&](const mrpt::math::TPoint2Df& normal) {
        return -(static_cast<double>(scan.points[i].y) - 1.2) * static_cast<double>(normal.y * normal.x);
      };
      pull_of_own_normals += slope_along(scan.normals[i]);
      pull += slope_along(tracked.matched.normals[i]);
    }
  }
  EXPECT_LT(std::abs(pull), 0.2 * std::abs(pull_of_own_normals));
}

TEST(TrackedPoints, posts_get_no_normals) {
  SimulatedWalls posts;  // each is hit by two or three neighbouring beams
  for (const double x : {3.0, 6.0, 10.0}) posts.add_box(x, 2, x + 0.15, 2.15);
  const ScanPoints scan = scan_of(posts, 0.005);
  ASSERT_GE(scan.points.size(), 4U);
  const TrackedPoints tracked = points_along_walls(scan);
  for (std::size_t i = 0; i < scan.points.size(); ++i) EXPECT_FALSE(is_set(tracked.matched.normals[i])) << i;
}

TEST(TrackedPoints, a_line_does_not_join_points_of_two_lasers) {
  ScanPoints scan;
  for (const float x : {10.0F, 14.0F, 19.0F, 25.0F}) scan.points.emplace_back(x, 1.0F);
  scan.normals.assign(4, {0, 0});
  EXPECT_TRUE(is_set(points_along_walls(scan).matched.normals[0]));
  scan.other_lasers.push_back({2, {0, 0}});
  for (const auto& normal : points_along_walls(scan).matched.normals) EXPECT_FALSE(is_set(normal));
}

TEST(TrackedPoints, without_normals_are_the_points_of_the_scan) {
  ScanPoints scan;
  for (const float x : {10.0F, 14.0F, 19.0F, 25.0F}) scan.points.emplace_back(x, 1.0F);
  const TrackedPoints tracked = points_along_walls(scan);
  EXPECT_EQ(tracked.matched.points, scan.points);
  EXPECT_TRUE(tracked.matched.normals.empty());
  EXPECT_TRUE(tracked.judged.points.empty());
}

}  // namespace
}  // namespace psi_slam
