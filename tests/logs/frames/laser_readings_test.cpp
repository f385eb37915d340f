// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/laser_readings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psi_slam {
namespace {

TEST(LaserReadings, are_returns_no_returns_or_invalid) {
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> returns{1.5F, 7.999F, 0.3F};
  std::vector<float> ranges_m = returns;
  mark_no_returns(ranges_m, 0.3, 8.0);
  EXPECT_EQ(ranges_m, returns);

  ranges_m = {8.0F, 81.91F, inf};
  mark_no_returns(ranges_m, 0.3, 8.0);
  EXPECT_EQ(ranges_m, std::vector<float>(3, inf)) << "at or beyond the maximum";

  ranges_m = {0.0F, -2.0F, -inf, std::nanf(""), 0.29F};
  mark_no_returns(ranges_m, 0.3, 8.0);
  for (const float range : ranges_m) EXPECT_TRUE(std::isnan(range)) << range;
}

TEST(LaserReadings, below_a_tenth_of_a_metre_are_invalid_unless_stated) {
  LaserScan scan;
  scan.ranges_m = {0.03F, 0.1F, 2.0F};
  LaserScan stated = scan;
  limit_ranges(scan, {}, 8);
  EXPECT_TRUE(std::isnan(scan.ranges_m[0]));
  EXPECT_EQ(scan.ranges_m[1], 0.1F);
  LogOptions options;
  options.min_range_m = 0.02;
  limit_ranges(stated, options, 8);
  EXPECT_EQ(stated.ranges_m[0], 0.03F);
}

TEST(LaserReadings, equal_the_maximum_if_written_alike) {
  std::vector<float> ranges_m{81.83F, 81.82F};
  mark_no_returns(ranges_m, 0, 81.83);
  EXPECT_TRUE(std::isinf(ranges_m[0]));
  EXPECT_TRUE(std::isfinite(ranges_m[1]));
}

TEST(LaserReadings, restores_bearings_that_a_message_states_as_floats) {
  for (const auto& [angles, beams, degrees] :
       {std::tuple{BeamAngles::kLeftOpen, std::size_t{180}, 180.0},
        {BeamAngles::kCentredStepInclusive, std::size_t{361}, 180.0},
        {BeamAngles::kCentredHalfStep, std::size_t{1080}, 270.0},
        {BeamAngles::kCentredStepInclusive, std::size_t{1081}, 270.0}}) {
    const double field_of_view_rad = degrees * M_PI / 180;
    const std::vector<float> bearings = make_bearings_rad(angles, beams, field_of_view_rad);
    const double steps = static_cast<double>(angles == BeamAngles::kCentredStepInclusive ? beams - 1 : beams);
    const auto stated_step = static_cast<float>(field_of_view_rad / steps);
    const auto even = bearings_of_whole_degrees(bearings.front(), static_cast<double>(stated_step), beams);
    ASSERT_TRUE(even) << beams;
    EXPECT_EQ(even->bearings_rad, bearings) << beams;
  }
  EXPECT_FALSE(bearings_of_whole_degrees(-1.57F, 0.0174, 180)) << "179.4 degrees from -90";
  EXPECT_FALSE(bearings_of_whole_degrees(1.57F, -0.01745, 180)) << "clockwise";
  EXPECT_FALSE(bearings_of_whole_degrees(0, 0, 1));
}

}  // namespace
}  // namespace psi_slam
