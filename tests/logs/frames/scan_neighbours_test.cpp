// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/scan_neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "logs/frames/laser_readings.h"

namespace psi_slam {
namespace {

std::vector<float> bearings_rad(BeamAngles angles, std::size_t beams, double field_of_view_deg) {
  return make_bearings_rad(angles, beams, field_of_view_deg * M_PI / 180);
}

TEST(ScanNeighbours, of_a_full_circle_include_the_ends) {
  EXPECT_TRUE(is_full_circle(bearings_rad(BeamAngles::kLeftOpen, 360, 360)));
  EXPECT_TRUE(is_full_circle(bearings_rad(BeamAngles::kCentredStepInclusive, 361, 360)))
      << "the last beam repeats the bearing of the first";
  std::vector<float> from_zero = bearings_rad(BeamAngles::kCentredHalfStep, 455, 360);
  for (float& bearing : from_zero) bearing += 3.1415927F;
  EXPECT_TRUE(is_full_circle(from_zero));
  std::reverse(from_zero.begin(), from_zero.end());
  EXPECT_TRUE(is_full_circle(from_zero)) << "clockwise";
}

TEST(ScanNeighbours, of_other_scans_exclude_the_ends) {
  for (const double field_of_view_deg : {90.0, 180.0, 270.0, 345.0})
    EXPECT_FALSE(is_full_circle(bearings_rad(BeamAngles::kCentredStepInclusive, 361, field_of_view_deg)))
        << field_of_view_deg;
  EXPECT_FALSE(is_full_circle(std::vector<float>(10, 0.5F))) << "all beams have one bearing";
  EXPECT_FALSE(is_full_circle({-3.14F, 3.14F}));
  EXPECT_FALSE(is_full_circle({}));
}

TEST(ScanNeighbours, of_a_circle_bent_by_a_turn_include_the_ends) {
  for (const double turn_rad : {-0.15, 0.15}) {
    std::vector<float> bearings = bearings_rad(BeamAngles::kLeftOpen, 720, 360);
    for (std::size_t i = 0; i < bearings.size(); ++i)
      bearings[i] += static_cast<float>(turn_rad * static_cast<double>(i) / 720);
    EXPECT_TRUE(is_full_circle(bearings)) << turn_rad;
  }
}

TEST(ScanNeighbours, end_where_elements_are_not_joined) {
  const auto all = [](std::size_t, std::size_t) { return true; };
  const auto first_and_last = [](const Neighbourhood& n) { return std::make_pair(n.first, n.last); };
  using Ends = std::pair<std::ptrdiff_t, std::ptrdiff_t>;
  EXPECT_EQ(first_and_last(neighbourhood(1, 10, 3, false, all)), Ends(0, 4));
  EXPECT_EQ(first_and_last(neighbourhood(8, 10, 3, false, all)), Ends(5, 9));
  EXPECT_EQ(first_and_last(neighbourhood(1, 10, 3, true, all)), Ends(-2, 4));
  EXPECT_EQ(first_and_last(neighbourhood(8, 10, 3, true, all)), Ends(5, 11));
  EXPECT_EQ(neighbourhood(1, 4, 3, true, all).count(), 4) << "no element belongs to it twice";
  const auto until_seam = [](std::size_t near, std::size_t far) { return near < 5 && far < 5; };
  EXPECT_EQ(first_and_last(neighbourhood(1, 10, 3, true, until_seam)), Ends(0, 4));
  EXPECT_EQ(index_on_ring(-2, 10), 8U);
  EXPECT_EQ(index_on_ring(9, 10), 9U);
  EXPECT_EQ(index_on_ring(11, 10), 1U);
}

}  // namespace
}  // namespace psi_slam
