// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/range_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPoint2Df;
using mrpt::math::TPose2D;

constexpr double kTolerance_m = 0.25;

ScanPoints scan_of(const std::vector<TPoint2Df>& points) {
  ScanPoints scan;
  scan.points = points;
  return scan;
}

// Points of a wall at x = 5, from y = -3 to y = 3.
std::vector<TPoint2Df> wall_ahead() {
  std::vector<TPoint2Df> points;
  for (int i = -300; i <= 300; ++i) points.emplace_back(5.0F, 0.01F * static_cast<float>(i));
  return points;
}

void expect_agreement(const RangeImage::Agreement& found, std::size_t agree, std::size_t contradict) {
  EXPECT_EQ(found.agree, agree);
  EXPECT_EQ(found.contradict, contradict);
}

TEST(RangeImage, points_at_the_measured_range_agree) {
  const RangeImage image(scan_of(wall_ahead()));
  expect_agreement(image.compare(scan_of({{5, 0.3F}, {5.2F, 1}, {4.8F, -1}}), {0, 0, 0}, kTolerance_m), 3, 0);
}

TEST(RangeImage, points_seen_through_contradict) {
  const RangeImage image(scan_of(wall_ahead()));
  expect_agreement(image.compare(scan_of({{4.6F, 0.3F}, {2, 0.5F}, {0.5F, 0.1F}}), {0, 0, 0}, kTolerance_m),
                   0, 3);
}

TEST(RangeImage, hidden_points_do_not_count) {
  const RangeImage image(scan_of(wall_ahead()));
  expect_agreement(image.compare(scan_of({{5.4F, 0.3F}, {9, 1}, {20, -2}}), {0, 0, 0}, kTolerance_m), 0, 0);
}

TEST(RangeImage, points_without_a_beam_do_not_count) {
  const RangeImage image(scan_of(wall_ahead()));
  expect_agreement(image.compare(scan_of({{-5, 0}, {0, 5}, {0, -1}, {1, 3}}), {0, 0, 0}, kTolerance_m), 0, 0);
}

TEST(RangeImage, uses_the_given_tolerance) {
  const RangeImage image(scan_of(wall_ahead()));
  const ScanPoints off = scan_of({{4.6F, 0.1F}, {5.4F, 0.1F}});
  expect_agreement(image.compare(off, {0, 0, 0}, 0.3), 0, 1);
  expect_agreement(image.compare(off, {0, 0, 0}, 0.5), 2, 0);
}

TEST(RangeImage, places_the_other_scan_by_its_pose) {
  const RangeImage image(scan_of(wall_ahead()));
  const TPose2D this_T_other(4, -1, M_PI / 2);
  // The other scan's points (1, -1), (1, 1) and (1, -3) are (5, 0), (3, 0) and (7, 0) in this scan's frame.
  expect_agreement(image.compare(scan_of({{1, -1}}), this_T_other, kTolerance_m), 1, 0);
  expect_agreement(image.compare(scan_of({{1, 1}}), this_T_other, kTolerance_m), 0, 1);
  expect_agreement(image.compare(scan_of({{1, -3}}), this_T_other, kTolerance_m), 0, 0);
}

TEST(RangeImage, points_between_an_edge_and_its_background_are_not_contradicted) {
  // One bin of bearings holds the edge of a pillar at 2 m and the wall behind it at 5 m.
  const RangeImage image(scan_of({{2, 0.01F}, {5, 0.07F}}));
  expect_agreement(image.compare(scan_of({{3.5F, 0.03F}}), {0, 0, 0}, kTolerance_m), 1, 0);
  expect_agreement(image.compare(scan_of({{1.5F, 0.01F}}), {0, 0, 0}, kTolerance_m), 0, 1);
  expect_agreement(image.compare(scan_of({{5.5F, 0.05F}}), {0, 0, 0}, kTolerance_m), 0, 0);
}

TEST(RangeImage, beams_start_at_the_laser_not_at_the_robot) {
  // The laser at (0, 2) sees a pillar at (2, 2) and, beside it, a wall at x = 6.
  ScanPoints scan;
  scan.origin = {0, 2};
  for (int i = -10; i <= 10; ++i) scan.points.emplace_back(2.0F, 2 + 0.01F * static_cast<float>(i));
  for (int i = -600; i <= 600; ++i) {
    const float y = 2 + 0.01F * static_cast<float>(i);
    if (std::abs(y - 2) > 0.6F) scan.points.emplace_back(6.0F, y);
  }
  const RangeImage image(scan);
  // As seen from the robot, (4, 4) is behind the pillar; as seen from the laser, it is in free space.
  expect_agreement(image.compare(scan_of({{4, 4}}), {0, 0, 0}, kTolerance_m), 0, 1);
  // As seen from the robot, (4, 2) is in front of the wall; as seen from the laser, the pillar hides it.
  expect_agreement(image.compare(scan_of({{4, 2}}), {0, 0, 0}, kTolerance_m), 0, 0);
}

TEST(RangeImage, a_full_circle_is_seen_at_every_bearing) {
  const auto circle = [](float radius_m) {
    ScanPoints scan;
    for (int i = 0; i < 720; ++i) {
      const float bearing = (static_cast<float>(i) + 0.5F) * static_cast<float>(M_PI) / 360;
      scan.points.emplace_back(radius_m * std::cos(bearing), radius_m * std::sin(bearing));
    }
    return scan;
  };
  const RangeImage image(circle(4));
  expect_agreement(image.compare(circle(4), {0, 0, 1.234}, kTolerance_m), 720, 0);
  expect_agreement(image.compare(circle(3), {0, 0, 1.234}, kTolerance_m), 0, 720);
  expect_agreement(image.compare(circle(5), {0, 0, 1.234}, kTolerance_m), 0, 0);
}

TEST(RangeImage, the_share_is_of_the_points_that_count) {
  const RangeImage image(scan_of(wall_ahead()));
  const ScanPoints mixed = scan_of({{5, 0.3F}, {5, 0.6F}, {5, 0.9F}, {2, 0}, {9, 0}, {-5, 0}});
  const RangeImage::Agreement found = image.compare(mixed, {0, 0, 0}, kTolerance_m);
  expect_agreement(found, 3, 1);
  EXPECT_EQ(found.share(), 0.75);
  EXPECT_EQ(RangeImage::Agreement().share(), 0);
}

TEST(RangeImage, scans_without_points_do_not_count) {
  expect_agreement(RangeImage(ScanPoints()).compare(scan_of(wall_ahead()), {0, 0, 0}, kTolerance_m), 0, 0);
  expect_agreement(RangeImage(scan_of(wall_ahead())).compare(ScanPoints(), {0, 0, 0}, kTolerance_m), 0, 0);
}

TEST(RangeImage, every_laser_has_its_own_position) {
  // The front laser at (1, 0) sees a wall at x = 5. The rear laser at (-1, 0) sees a wall at x = -6.
  ScanPoints scan = scan_of(wall_ahead());
  scan.origin = {1, 0};
  scan.other_lasers.push_back({scan.points.size(), {-1, 0}});
  for (int i = -300; i <= 300; ++i) scan.points.emplace_back(-6.0F, 0.01F * static_cast<float>(i));
  const RangeImage image(scan);
  const auto judge = [&](float x, float y) {
    return image.compare(scan_of({{x, y}}), {0, 0, 0}, kTolerance_m);
  };
  expect_agreement(judge(5, 0), 1, 0);
  expect_agreement(judge(-6, 0), 1, 0);
  expect_agreement(judge(-4, 0), 0, 1);
  expect_agreement(judge(-7, 0), 0, 0);
  // Neither laser has points in the direction of (0, 0), although the other laser has points at the same
  // bearing.
  expect_agreement(judge(0, 0), 0, 0);
}

}  // namespace
}  // namespace psi_slam
