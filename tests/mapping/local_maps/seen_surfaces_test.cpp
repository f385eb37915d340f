// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/seen_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "simulated_drive.h"

namespace psi_slam {
namespace {

constexpr double kMaxRange_m = 40;
constexpr double kNoRange = std::numeric_limits<double>::quiet_NaN();

// Returns a scan of 181 beams, one degree apart. `range_at` gives the range for a bearing.
template <class RangeAt>
LaserScan scan_of(RangeAt range_at) {
  LaserScan scan;
  scan.bearings_rad = even_bearings(-M_PI / 2, M_PI / 2, 181);
  for (const float bearing : *scan.bearings_rad)
    scan.ranges_m.push_back(static_cast<float>(range_at(static_cast<double>(bearing))));
  scan.max_range_m = 80;
  return scan;
}

// Returns the range in metres to a wall across the robot's path, `x_m` ahead. Returns NaN beyond 60 m.
double wall_across(double x_m, double bearing_rad) {
  const double range = x_m / std::cos(bearing_rad);
  return range > 0 && range < 60 ? range : kNoRange;
}

std::size_t beam_at(double bearing_deg) {
  return static_cast<std::size_t>(std::lround(bearing_deg + 90));
}

std::vector<bool> joined_ends(const LaserScan& scan, double max_range_m) {
  return ends_on_one_surface(scan, max_range_m, 0.03);
}

TEST(SeenSurfaces, join_all_ends_on_a_far_wall_seen_head_on) {
  for (const double x_m : {5.0, 10.0, 20.0, 35.0}) {
    const auto joined = joined_ends(scan_of([&](double b) { return wall_across(x_m, b); }), 40);
    for (int deg = -25; deg <= 25; ++deg) EXPECT_TRUE(joined[beam_at(deg)]) << x_m << " m, " << deg;
  }
}

TEST(SeenSurfaces, join_the_ends_on_a_wall_despite_range_noise) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.02);
  const auto joined =
      joined_ends(scan_of([&](double b) { return wall_across(20, b) + noise(random); }), kMaxRange_m);
  const auto count = std::count(joined.begin() + 70, joined.begin() + 111, true);
  EXPECT_GE(count, 39);
}

TEST(SeenSurfaces, need_no_join_where_beams_hit_every_cell) {
  const auto joined = joined_ends(scan_of([](double b) { return wall_across(2, b); }), kMaxRange_m);
  for (int deg = -20; deg <= 20; ++deg) EXPECT_FALSE(joined[beam_at(deg)]) << deg;
}

TEST(SeenSurfaces, do_not_join_beams_nearer_than_the_spacing) {
  const LaserScan scan = scan_of([](double b) { return wall_across(10, b); });  // spacing 0.17 m
  const auto wider = ends_on_one_surface(scan, kMaxRange_m, 0.16);
  const auto narrower = ends_on_one_surface(scan, kMaxRange_m, 0.18);
  EXPECT_TRUE(wider[beam_at(0)]);
  EXPECT_FALSE(narrower[beam_at(0)]);
  EXPECT_TRUE(narrower[beam_at(-30)]) << "the beams are 0.2 m apart there";
}

TEST(SeenSurfaces, do_not_join_across_an_open_door) {
  // The beams from 2 to 6 degrees pass through the door to a wall 5 m behind it.
  const auto joined = joined_ends(scan_of([](double b) {
                                    const double deg = b * 180 / M_PI;
                                    return wall_across(deg > 1.5 && deg < 6.5 ? 15 : 10, b);
                                  }),
                                  kMaxRange_m);
  EXPECT_TRUE(joined[beam_at(1)]);
  EXPECT_FALSE(joined[beam_at(2)]);
  EXPECT_TRUE(joined[beam_at(4)]) << "beams on the wall behind the door are joined";
  EXPECT_FALSE(joined[beam_at(7)]);
  EXPECT_TRUE(joined[beam_at(8)]);
}

TEST(SeenSurfaces, do_not_join_beams_on_scattered_objects) {
  // Ranges as from trunks and legs: the line through two neighbouring ends rarely meets a third end.
  const auto joined = joined_ends(
      scan_of([](double b) { return 15 + 4 * std::cos(40 * b) * std::cos(17 * b); }), kMaxRange_m);
  EXPECT_LE(std::count(joined.begin(), joined.end(), true), 36)
      << "a fifth of the beams may be joined by chance";
}

TEST(SeenSurfaces, do_not_join_along_a_wall_at_a_grazing_angle) {
  // A corridor wall 1 m beside the robot. 20 m ahead, neighbouring beams hit it 7 m apart.
  const auto joined =
      joined_ends(scan_of([](double b) { return b > 0.01 ? 1 / std::sin(b) : kNoRange; }), kMaxRange_m);
  for (int deg = 2; deg <= 10; ++deg) EXPECT_FALSE(joined[beam_at(deg)]) << deg;
  EXPECT_TRUE(joined[beam_at(20)]);
}

TEST(SeenSurfaces, join_no_ends_without_return_or_beyond_the_range) {
  const auto far = joined_ends(scan_of([](double b) { return wall_across(20, b); }), 19);
  EXPECT_EQ(std::count(far.begin(), far.end(), true), 0);
  const auto gap = joined_ends(
      scan_of([](double b) { return std::lround(b * 180 / M_PI) == 3 ? kNoRange : wall_across(20, b); }),
      kMaxRange_m);
  EXPECT_FALSE(gap[beam_at(3)]);
  EXPECT_FALSE(gap[beam_at(4)]);
  EXPECT_TRUE(gap[beam_at(5)]);
}

TEST(SeenSurfaces, join_the_ends_of_a_full_circle) {
  LaserScan scan;  // the wall is ahead, and so are the first and the last beam
  scan.bearings_rad = even_bearings(0, 2 * M_PI * 359 / 360, 360);
  for (const float bearing : *scan.bearings_rad)
    scan.ranges_m.push_back(static_cast<float>(wall_across(10, static_cast<double>(bearing))));
  for (const std::size_t beam : {358U, 359U, 0U, 1U}) EXPECT_TRUE(joined_ends(scan, kMaxRange_m)[beam]);
  scan.ranges_m[358] = scan.ranges_m[1] = static_cast<float>(kNoRange);
  EXPECT_FALSE(joined_ends(scan, kMaxRange_m)[0]) << "no third beam shows that the surface continues";
  scan.bearings_rad = even_bearings(0, 2 * M_PI * 350 / 360, 360);
  EXPECT_FALSE(joined_ends(scan, kMaxRange_m)[0]) << "ten degrees are unseen";
}

TEST(SeenSurfaces, of_scans_with_few_beams_are_none) {
  for (int beams = 0; beams < 3; ++beams) {
    LaserScan scan;
    std::vector<float> bearings;
    for (int i = 0; i < beams; ++i) bearings.push_back(0.02F * static_cast<float>(i));
    scan.bearings_rad = std::make_shared<const std::vector<float>>(bearings);
    scan.ranges_m.assign(static_cast<std::size_t>(beams), 10);
    const auto joined = joined_ends(scan, kMaxRange_m);
    EXPECT_EQ(std::count(joined.begin(), joined.end(), true), 0) << beams;
  }
}

}  // namespace
}  // namespace psi_slam
