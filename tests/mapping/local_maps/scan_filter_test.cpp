// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/scan_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "simulated_drive.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2Df;
using mrpt::math::TPose2D;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

LaserScan scan_of(std::vector<float> ranges_m, const TPose2D& robot_T_laser = {0, 0, 0}) {
  LaserScan scan;
  scan.bearings_rad = even_bearings(-M_PI / 2, M_PI / 2, static_cast<int>(ranges_m.size()));
  scan.ranges_m = std::move(ranges_m);
  scan.max_range_m = 80;
  scan.robot_T_laser = robot_T_laser;
  return scan;
}

ScanFilterOptions without_thinning() {
  ScanFilterOptions options;
  options.spacing_m = 0;
  return options;
}

double length(const TPoint2Df& v) {
  return std::hypot(static_cast<double>(v.x), static_cast<double>(v.y));
}

double distance(const TPoint2Df& a, const TPoint2Df& b) {
  return length({a.x - b.x, a.y - b.y});
}

// Returns 1 minus the cosine of the angle between a normal and a direction, regardless of sign; 1 without a
// normal.
double off_direction(const TPoint2Df& normal, double direction_rad) {
  return 1 - std::abs(static_cast<double>(normal.x) * std::cos(direction_rad) +
                      static_cast<double>(normal.y) * std::sin(direction_rad));
}

TEST(MatchingPoints, lie_where_the_beams_ended_in_the_robots_frame) {
  // The laser is at the front of the robot and turned to the left.
  const ScanPoints scan = matching_points(scan_of({2, 3, 4}, {0.5, -0.25, M_PI / 2}), without_thinning());
  ASSERT_EQ(scan.points.size(), 3U);
  EXPECT_NEAR(distance(scan.points[0], {2.5F, -0.25F}), 0, 1e-6);
  EXPECT_NEAR(distance(scan.points[1], {0.5F, 2.75F}), 0, 1e-6);
  EXPECT_NEAR(distance(scan.points[2], {-3.5F, -0.25F}), 0, 1e-6);
  EXPECT_NEAR(distance(scan.origin, {0.5F, -0.25F}), 0, 1e-6);
}

TEST(MatchingPoints, of_successive_scans_depend_on_bearings_and_mount_of_each) {
  LaserScan scan = scan_of({2, 3, 4});
  matching_points(scan, without_thinning());
  scan.robot_T_laser.phi = M_PI / 2;  // another mount, same bearings
  const ScanPoints turned = matching_points(scan, without_thinning());
  EXPECT_NEAR(distance(turned.points[1], {0, 3}), 0, 1e-6);
  scan.bearings_rad = even_bearings(0, M_PI, 3);  // other bearings, same mount
  const ScanPoints other = matching_points(scan, without_thinning());
  EXPECT_NEAR(distance(other.points[1], {-3, 0}), 0, 1e-6);
}

TEST(MatchingPoints, the_farthest_is_measured_from_the_robot_not_from_the_laser) {
  const ScanPoints scan = matching_points(scan_of({2, 3, 4}, {0.5, -0.25, 0}), without_thinning());
  double farthest = 0;
  for (const auto& point : scan.points) farthest = std::max(farthest, length(point));
  EXPECT_NEAR(scan.farthest_m, farthest, 1e-6);
  EXPECT_NEAR(scan.farthest_m, std::hypot(0.5, 3.75), 1e-6);
}

TEST(MatchingPoints, only_returns_up_to_the_largest_range) {
  ScanFilterOptions options = without_thinning();
  options.max_range_m = 10;
  const ScanPoints scan =
      matching_points(scan_of({kNan, 0.5F, 5, 10, 10.01F, kInfinity, -1, 0, -kInfinity, kNan}), options);
  ASSERT_EQ(scan.points.size(), 3U);
  EXPECT_NEAR(length(scan.points[0]), 0.5, 1e-6);
  EXPECT_NEAR(length(scan.points[1]), 5, 1e-6);
  EXPECT_NEAR(length(scan.points[2]), 10, 1e-6);
}

TEST(MatchingPoints, a_scan_without_returns_gives_none) {
  for (const LaserScan& scan : {scan_of({kNan, kNan, kNan}), LaserScan{{}, even_bearings(0, 1, 2), 80, {}}}) {
    const ScanPoints points = matching_points(scan, {});
    EXPECT_TRUE(points.points.empty());
    EXPECT_TRUE(points.normals.empty());
    EXPECT_EQ(points.farthest_m, 0);
  }
}

TEST(MatchingPoints, neighbours_nearer_than_the_spacing_are_dropped) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> range(0.05F, 3.0F);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<float> ranges;
    for (int i = 0; i < 181; ++i)
      ranges.push_back(trial % 2 == 0 ? 1.0F + 0.002F * range(random) : range(random));
    const LaserScan scan = scan_of(ranges);
    ScanFilterOptions options;
    options.spacing_m = 0.02 + 0.004 * trial;
    const std::vector<TPoint2Df> kept = matching_points(scan, options).points;

    const std::vector<TPoint2Df> all = matching_points(scan, without_thinning()).points;
    std::vector<TPoint2Df> expected;
    for (const TPoint2Df& point : all)
      if (expected.empty() || distance(point, expected.back()) >= options.spacing_m)
        expected.push_back(point);
    EXPECT_EQ(kept, expected) << "spacing " << options.spacing_m;
    EXPECT_LT(kept.size(), all.size());
  }
}

TEST(MatchingPointNormals, of_a_wall_are_square_to_it) {
  SimulatedWalls wall;
  wall.add_wall(-6, 2, 9, 4.5);
  const double direction = std::atan2(2.5, 15.0) + M_PI / 2;
  std::mt19937_64 random(2);
  for (const double heading : {0.0, 0.7, -0.5}) {
    const TPose2D robot(0, 0, heading);
    const LaserScan scan =
        simulated_scan(wall, robot, even_bearings(0.2, 2.6, 100), {0.2, 0.1, 0.3}, 0, random);
    const ScanPoints points = matching_points(scan, {});
    ASSERT_EQ(points.normals.size(), points.points.size());
    ASSERT_GT(points.points.size(), 40U);
    for (const TPoint2Df& normal : points.normals) {
      EXPECT_NEAR(length(normal), 1, 1e-5);
      EXPECT_LT(off_direction(normal, direction - heading), 1e-4) << "in the robot's frame";
    }
  }
}

TEST(MatchingPointNormals, tolerate_a_noisy_range) {
  SimulatedWalls wall;
  wall.add_wall(-6, 2, 6, 2);
  std::mt19937_64 random(3);
  const LaserScan scan =
      simulated_scan(wall, {0, 0, 0}, even_bearings(0.5, 2.6, 100), {0, 0, 0}, 0.01, random);
  const ScanPoints points = matching_points(scan, {});
  for (const TPoint2Df& normal : points.normals)
    EXPECT_LT(off_direction(normal, M_PI / 2), 1 - std::cos(0.35)) << "within 20 degrees";
}

TEST(MatchingPointNormals, a_corner_has_none_but_its_walls_do) {
  SimulatedWalls corner;
  corner.add_wall(3, -3, 3, 3);
  corner.add_wall(-3, 3, 3, 3);
  std::mt19937_64 random(4);
  const LaserScan scan =
      simulated_scan(corner, {0, 0, 0}, even_bearings(-0.5, 2.0, 120), {0, 0, 0}, 0, random);
  const ScanPoints points = matching_points(scan, {});
  int at_the_corner = 0;
  int on_walls = 0;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const double from_corner = distance(points.points[i], {3, 3});
    if (from_corner < 0.1) {
      ++at_the_corner;
      EXPECT_EQ(points.normals[i], TPoint2Df(0, 0)) << "point " << i;
    } else if (from_corner > 0.7) {
      ++on_walls;
      const bool on_the_right = static_cast<double>(points.points[i].x) > 2.99;
      EXPECT_LT(off_direction(points.normals[i], on_the_right ? 0 : M_PI / 2), 1e-4) << "point " << i;
    }
  }
  EXPECT_GT(at_the_corner, 0);
  EXPECT_GT(on_walls, 40);
}

TEST(MatchingPointNormals, isolated_points_have_none) {
  std::vector<float> ranges(181, kNan);
  for (const std::size_t i : {20U, 60U, 61U, 62U, 120U}) ranges[i] = 5;  // beams 60 to 62 hit one post
  const ScanPoints points = matching_points(scan_of(ranges), without_thinning());
  ASSERT_EQ(points.points.size(), 5U);
  for (const TPoint2Df& normal : points.normals) EXPECT_EQ(normal, TPoint2Df(0, 0));
}

TEST(MatchingPointNormals, of_a_wall_across_the_ends_of_a_full_circle_are_square_to_it) {
  // Two points are on each side of the seam, which is too few for a normal.
  SimulatedWalls wall;
  wall.add_wall(2, -0.06, 2, 0.06);
  std::mt19937_64 random(6);
  const double half_step_rad = M_PI / 360;
  const BeamBearings circle = even_bearings(half_step_rad, 2 * M_PI - half_step_rad, 360);
  const ScanPoints points =
      matching_points(simulated_scan(wall, {0, 0, 0}, circle, {0, 0, 0}, 0, random), without_thinning());
  ASSERT_EQ(points.points.size(), 4U);
  for (const TPoint2Df& normal : points.normals) EXPECT_LT(off_direction(normal, 0), 1e-4);
}

TEST(MatchingPointNormals, a_line_is_not_drawn_across_a_gap) {
  // Two parallel walls with an edge between them. Points at the edge have neighbours on one side only.
  SimulatedWalls steps;
  steps.add_wall(-4, 2, 0, 2);
  steps.add_wall(0, 4, 4, 4);
  std::mt19937_64 random(5);
  const LaserScan scan = simulated_scan(steps, {0, 0, 0}, even_bearings(0.9, 2.2, 90), {0, 0, 0}, 0, random);
  const ScanPoints points = matching_points(scan, {});
  for (const TPoint2Df& normal : points.normals) EXPECT_LT(off_direction(normal, M_PI / 2), 1e-4);
}

TEST(DrawingBeams, start_at_the_laser_and_end_at_the_returns) {
  const TPose2D map_T_robot(1, 2, M_PI / 2);
  const Beams beams = drawing_beams(scan_of({2, 3, 4}, {0.5, 0, 0}), map_T_robot, {40});
  EXPECT_NEAR(beams.origin.x, 1, 1e-9);
  EXPECT_NEAR(beams.origin.y, 2.5, 1e-9);
  ASSERT_EQ(beams.ends.size(), 3U);
  EXPECT_NEAR(beams.ends[0].x, 3, 1e-6);
  EXPECT_NEAR(beams.ends[0].y, 2.5, 1e-6);
  EXPECT_NEAR(beams.ends[1].x, 1, 1e-6);
  EXPECT_NEAR(beams.ends[1].y, 5.5, 1e-6);
  EXPECT_NEAR(beams.ends[2].x, -3, 1e-6);
  EXPECT_NEAR(beams.ends[2].y, 2.5, 1e-6);
  EXPECT_EQ(beams.hits, std::vector<bool>(3, true));
}

TEST(DrawingBeams, are_cut_at_the_largest_range_and_dropped_without_a_return) {
  const Beams beams = drawing_beams(scan_of({0, 5, 6, 7, kNan, kInfinity}), {0, 0, 0}, {6});
  ASSERT_EQ(beams.ends.size(), 3U);
  EXPECT_EQ(beams.hits, (std::vector<bool>{true, true, false}));
  EXPECT_NEAR(beams.ends[2].norm(), 6, 1e-6);
}

TEST(DrawingBeams, join_the_ends_on_a_wall_but_not_to_a_dropped_beam) {
  LaserScan scan;
  scan.bearings_rad = even_bearings(-0.03, 0.03, 4);
  scan.max_range_m = 80;
  scan.ranges_m.assign(4, 10);
  EXPECT_EQ(drawing_beams(scan, {0, 0, 0}, {}).joined, (std::vector<bool>{false, true, true, true}));
  scan.ranges_m[0] = kNan;
  DrawingOptions options;
  EXPECT_EQ(drawing_beams(scan, {0, 0, 0}, options).joined, (std::vector<bool>{false, true, true}));
  options.min_surface_spacing_m = 0.3;
  EXPECT_EQ(drawing_beams(scan, {0, 0, 0}, options).joined, std::vector<bool>(3, false));
}

TEST(DrawingBeams, join_the_ends_of_a_full_circle_but_not_to_a_dropped_beam) {
  LaserScan scan;
  scan.bearings_rad = even_bearings(-M_PI, M_PI - M_PI / 60, 120);
  scan.max_range_m = 80;
  scan.ranges_m.assign(120, 5);
  EXPECT_TRUE(drawing_beams(scan, {0, 0, 0}, {}).joined[0]);
  scan.ranges_m[119] = kNan;
  EXPECT_FALSE(drawing_beams(scan, {0, 0, 0}, {}).joined[0]);
}

/// The ranges of the front laser are 2 m, those of the rear laser 3 m, with one beam without return. Between
/// the two scans, the robot turned left by 0.1 rad.
Frame two_laser_frame() {
  Frame frame;
  frame.scan = scan_of({2, 2, 2}, {0.5, 0, 0});
  CompanionScan rear{scan_of({3, kNan, 3}, {-0.5, 0, M_PI}), 50'000, {0, 0, 0.1}};
  rear.scan.laser = 1;
  frame.companions.push_back(rear);
  return frame;
}

TEST(MatchingPoints, of_a_frame_are_those_of_all_its_lasers_each_seen_from_its_own_place) {
  const Frame frame = two_laser_frame();
  const ScanPoints both = matching_points(frame, without_thinning());
  const ScanPoints front = matching_points(frame.scan, without_thinning());
  const ScanPoints rear = matching_points(frame.companions[0].scan, without_thinning());
  ASSERT_EQ(both.points.size(), 5U);
  ASSERT_EQ(both.normals.size(), 5U);
  EXPECT_TRUE(std::equal(front.points.begin(), front.points.end(), both.points.begin()));
  for (std::size_t i = 0; i < 2; ++i) {
    const TPose2D turned(0, 0, 0.1);
    const auto expected =
        turned.composePoint({static_cast<double>(rear.points[i].x), static_cast<double>(rear.points[i].y)});
    EXPECT_NEAR(static_cast<double>(both.points[3 + i].x), expected.x, 1e-5);
    EXPECT_NEAR(static_cast<double>(both.points[3 + i].y), expected.y, 1e-5);
  }
  ASSERT_EQ(both.other_lasers.size(), 1U);
  EXPECT_EQ(both.other_lasers[0].first_point, 3U);
  EXPECT_NEAR(static_cast<double>(both.other_lasers[0].origin.x), -0.5 * std::cos(0.1), 1e-6);
  EXPECT_NEAR(static_cast<double>(both.other_lasers[0].origin.y), -0.5 * std::sin(0.1), 1e-6);
  EXPECT_NEAR(both.farthest_m, rear.farthest_m, 1e-9);
  std::vector<std::size_t> ends;
  for_each_laser(both, [&](const TPoint2Df&, std::size_t, std::size_t end) { ends.push_back(end); });
  EXPECT_EQ(ends, (std::vector<std::size_t>{3, 5}));
}

TEST(DrawingBeams, of_a_frame_begin_at_each_of_its_lasers) {
  const auto beams = drawing_beams(two_laser_frame(), {10, 20, M_PI / 2}, {40});
  ASSERT_EQ(beams.size(), 2U);
  EXPECT_NEAR(beams[0].origin.y, 20.5, 1e-9);
  EXPECT_NEAR(beams[1].origin.x, 10 + 0.5 * std::sin(0.1), 1e-9);
  EXPECT_NEAR(beams[1].origin.y, 20 - 0.5 * std::cos(0.1), 1e-9);
  EXPECT_EQ(beams[1].ends.size(), 2U);
}

}  // namespace
}  // namespace psi_slam
