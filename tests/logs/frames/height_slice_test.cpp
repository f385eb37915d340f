// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/height_slice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint3Df;
using mrpt::poses::CPose3D;

constexpr HeightSlice kSlice{0.1, 1.0};

/// Returns the ranges of the scan by bearing, without invalid beams.
std::map<double, double> returns_of(const LaserScan& scan) {
  std::map<double, double> returns;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i)
    if (std::isfinite(scan.ranges_m[i]))
      returns[static_cast<double>((*scan.bearings_rad)[i])] = static_cast<double>(scan.ranges_m[i]);
  return returns;
}

void expect_return(const LaserScan& scan, double bearing_rad, double range_m) {
  const auto returns = returns_of(scan);
  ASSERT_EQ(returns.size(), 1U);
  EXPECT_NEAR(returns.begin()->first, bearing_rad, 1e-6);
  EXPECT_NEAR(returns.begin()->second, range_m, 1e-5);
}

TEST(HeightSlice, is_a_text_of_two_heights) {
  LogOptions options;
  EXPECT_FALSE(height_slice(options));
  options.slice_z_m = "  -0.2 1.5 ";
  const auto slice = height_slice(options);
  ASSERT_TRUE(slice);
  EXPECT_EQ(slice->low_m, -0.2);
  EXPECT_EQ(slice->high_m, 1.5);
  for (const char* text : {"a b", "1", "0.1 1.0 2", "1.0 0.1", "1 1", "nan 1", "0.1,1.0"}) {
    options.slice_z_m = text;
    EXPECT_EQ(sentence_of([&] { check_log_options(options); }),
              std::string("log.slice_z_m is \"") + text +
                  "\", expected two heights above the floor in metres, the lower one first, such as \"0.1 "
                  "1.0\"");
  }
}

TEST(ScanOfSlice, a_beam_is_the_nearest_point_between_the_heights) {
  const CPose3D mount(0.2, 0, 0.5, 0, 0, 0);
  const std::vector<TPoint3Df> points{
      {3, 4, 0},          // 0.5 m above the floor
      {6, 8, 0.2F},       // hidden behind it
      {1.5F, 2, -0.45F},  // on the floor
      {0.9F, 1.2F, 2},    // the ceiling
      {std::nanf(""), 1, 0},
      {1, 1, std::numeric_limits<float>::infinity()},
      {0, 0, 0},
  };
  const LaserScan scan = scan_of_slice(points, mount, kSlice, {});
  expect_return(scan, std::atan2(4, 3), 5);
  EXPECT_EQ(scan.robot_T_laser, mrpt::math::TPose2D(0.2, 0, 0));
  EXPECT_EQ(scan.ranges_m.size(), 720U);
  EXPECT_TRUE(std::is_sorted(scan.bearings_rad->begin(), scan.bearings_rad->end()));
  for (const float range_m : scan.ranges_m)
    EXPECT_FALSE(std::isinf(range_m)) << "a beam without a point says nothing of free space";
}

TEST(ScanOfSlice, ranges_are_limited_to_those_of_lasers) {
  LogOptions options;
  options.max_range_m = 5000;
  const std::vector<TPoint3Df> points{{2000, 0, 0.3F}, {0, 900, 0.3F}};
  const LaserScan scan = scan_of_slice(points, CPose3D(), kSlice, options);
  EXPECT_EQ(scan.max_range_m, 1000);
  expect_return(scan, M_PI / 2, 900);
}

TEST(ScanOfSlice, points_all_around_have_one_beam_for_each_half_degree) {
  std::vector<TPoint3Df> points;
  for (int i = 0; i < 2880; ++i) {
    const double bearing_rad = 2 * M_PI * (i + 0.3) / 2880;
    points.emplace_back(static_cast<float>(3 * std::cos(bearing_rad)),
                        static_cast<float>(3 * std::sin(bearing_rad)), 0.3F);
  }
  const LaserScan scan = scan_of_slice(points, CPose3D(0, 0, 0, 2.5, 0, 0), kSlice, {});
  EXPECT_EQ(returns_of(scan).size(), 720U);
  EXPECT_TRUE(std::is_sorted(scan.bearings_rad->begin(), scan.bearings_rad->end()));
}

// An optical frame looks along z, its x axis points right and its y axis points down.
TEST(ScanOfSlice, the_sensor_may_have_any_attitude) {
  const CPose3D camera(0.3, 0.1, 0.6, -M_PI / 2, 0, -M_PI / 2);
  const std::vector<TPoint3Df> points{{-1, 0.2F, 2}};
  const LaserScan scan = scan_of_slice(points, camera, kSlice, {});
  ASSERT_EQ(returns_of(scan).size(), 1U);
  const auto [bearing_rad, range_m] = *returns_of(scan).begin();
  const mrpt::math::TPose2D robot_T_point =
      scan.robot_T_laser +
      mrpt::math::TPose2D(range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad), 0);
  EXPECT_NEAR(robot_T_point.x, 0.3 + 2, 1e-5);
  EXPECT_NEAR(robot_T_point.y, 0.1 + 1, 1e-5);
}

TEST(ScanOfSlice, a_sensor_that_hangs_upside_down_sees_left_and_right_exchanged) {
  const std::vector<TPoint3Df> point{{2, 1, 0.4F}};
  expect_return(scan_of_slice(point, CPose3D(0, 0, 1, 0, 0, M_PI), kSlice, {}), std::atan2(-1, 2),
                std::sqrt(5.0));
  LogOptions options;
  options.mirrored = true;
  expect_return(scan_of_slice(point, CPose3D(0, 0, 1, 0, 0, 0), kSlice, options), std::atan2(-1, 2),
                std::sqrt(5.0));
  EXPECT_TRUE(returns_of(scan_of_slice(point, CPose3D(0, 0, 1, 0, 0, 0), kSlice, {})).empty())
      << "the point is 1.4 m above the floor";
}

TEST(ScanOfSlice, the_options_limit_ranges_and_state_the_mount) {
  const std::vector<TPoint3Df> points{{1, 0, 0.5F}, {2, 0, 0.5F}, {0, 4, 0.5F}, {-60, 0, 0.5F}};
  LogOptions options;
  options.min_range_m = 1.5;
  options.max_range_m = 3.5;
  options.robot_T_laser = mrpt::math::TPose2D(0.1, 0.2, 0.3);
  const LaserScan scan = scan_of_slice(points, {}, kSlice, options);
  expect_return(scan, 0, 2);
  EXPECT_EQ(scan.robot_T_laser, *options.robot_T_laser);
  EXPECT_EQ(scan.max_range_m, 3.5F);
  EXPECT_EQ(returns_of(scan_of_slice(points, {}, kSlice, {})).size(), 2U)
      << "a far point is no beam without a return, which would be free";
}

}  // namespace
}  // namespace psi_slam
