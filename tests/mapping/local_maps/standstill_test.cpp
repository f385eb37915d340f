// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/standstill.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kRate_hz = 10;
constexpr double kNoise_m = 0.004;

Frame frame_at(int scan, bool has_odometry = true, const TPose2D& odom_T_robot = {}) {
  Frame frame;
  frame.time_us = 1'000'000'000 + static_cast<TimeUs>(1e6 / kRate_hz) * scan;
  frame.has_odometry = has_odometry;
  frame.odom_T_robot = odom_T_robot;
  return frame;
}

/// Poses of a robot that stands at a place, with the noise of matches.
class NoisyPlace {
 public:
  TPose2D pose(double moved_m = 0) {
    return {3 + moved_m + kNoise_m * noise_(random_), 2 + kNoise_m * noise_(random_),
            0.001 * noise_(random_)};
  }

 private:
  std::mt19937_64 random_{1};
  std::normal_distribution<double> noise_{0, 1};
};

/// Adds the scans of `duration_s` seconds at one place.
Standstill standing_for(double duration_s, NoisyPlace& place, bool has_odometry = true) {
  Standstill standstill;
  for (int scan = 0; scan < duration_s * kRate_hz; ++scan)
    standstill.add(frame_at(scan, has_odometry), place.pose(), true);
  return standstill;
}

TEST(Standstill, is_long_after_ten_seconds_with_odometry_and_without) {
  for (const bool has_odometry : {true, false}) {
    NoisyPlace place;
    EXPECT_FALSE(standing_for(9.8, place, has_odometry).is_long(frame_at(98, has_odometry)));
    const Standstill standstill = standing_for(10, place, has_odometry);
    EXPECT_TRUE(standstill.is_long(frame_at(100, has_odometry)));
    EXPECT_NEAR(standstill.place().x, 3, 0.002);
    EXPECT_NEAR(standstill.place().y, 2, 0.002);
  }
}

TEST(Standstill, is_not_long_if_the_scans_are_few) {
  Standstill standstill;
  for (int scan = 0; scan < 400; scan += 10) standstill.add(frame_at(scan), {}, true);
  EXPECT_FALSE(standstill.is_long(frame_at(400)));
}

TEST(Standstill, ends_if_odometry_moves_by_millimetres_or_disappears) {
  NoisyPlace place;
  const Standstill standstill = standing_for(20, place);
  EXPECT_TRUE(standstill.is_long(frame_at(200, true, {0.001, 0, 0})));
  EXPECT_FALSE(standstill.is_long(frame_at(200, true, {0.003, 0, 0})));
  EXPECT_FALSE(standstill.is_long(frame_at(200, true, {0, 0, 0.003})));
  EXPECT_FALSE(standstill.is_long(frame_at(200, false)));
}

TEST(Standstill, ends_if_time_steps_back) {
  NoisyPlace place;
  EXPECT_FALSE(standing_for(20, place).is_long(frame_at(150)));
}

TEST(Standstill, unmatched_scans_end_it_only_without_odometry) {
  NoisyPlace place;
  for (const bool has_odometry : {true, false}) {
    Standstill standstill = standing_for(20, place, has_odometry);
    standstill.add(frame_at(200, has_odometry), place.pose(), false);
    EXPECT_EQ(standstill.is_long(frame_at(201, has_odometry)), has_odometry);
  }
}

TEST(Standstill, noise_of_matches_does_not_end_it) {
  NoisyPlace place;
  Standstill standstill = standing_for(20, place);
  for (int scan = 0; scan < 2000; ++scan) ASSERT_TRUE(standstill.confirm(place.pose())) << scan;
}

TEST(Standstill, slow_motion_ends_it_within_a_centimetre) {
  NoisyPlace place;
  Standstill standstill = standing_for(20, place);
  double moved_m = 0;
  while (standstill.confirm(place.pose(moved_m))) moved_m += 1e-4;
  EXPECT_GT(moved_m, 0.001);
  EXPECT_LT(moved_m, 0.01);
  EXPECT_FALSE(standstill.is_long(frame_at(200)));
}

TEST(Standstill, scans_without_ranges_do_not_change_the_place_of_later_scans) {
  NoisyPlace place;
  Standstill standstill = standing_for(20, place);
  for (int scan = 0; scan < 5; ++scan) standstill.confirm({3.012, 2, 0});
  standstill.skip();
  EXPECT_TRUE(standstill.confirm({3.012, 2, 0})) << "one scan may have this error";
}

TEST(Standstill, keeps_scans_in_growing_steps) {
  NoisyPlace place;
  Standstill standstill = standing_for(10, place);
  int kept = 0;
  for (int scan = 100; scan < 100'000; ++scan) kept += standstill.keeps(frame_at(scan).time_us) ? 1 : 0;
  const double expected = std::log(1000) / std::log(1.05);
  EXPECT_NEAR(kept, expected, 0.2 * expected);
}

}  // namespace
}  // namespace psi_slam
