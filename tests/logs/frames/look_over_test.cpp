// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/look_over.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

constexpr TimeUs kOneSecond = 1'000'000;

TEST(LookOver, ends_some_seconds_after_the_first_scan) {
  LookOver look_over(5);
  EXPECT_FALSE(look_over.began());
  EXPECT_FALSE(look_over.is_enough());
  look_over.add_scan(100 * kOneSecond);
  EXPECT_TRUE(look_over.began());
  look_over.add_scan(105 * kOneSecond - 1);
  EXPECT_FALSE(look_over.is_enough());
  look_over.add_scan(105 * kOneSecond);
  EXPECT_TRUE(look_over.is_enough());
}

TEST(LookOver, needs_a_scan) {
  LookOver look_over(0);
  EXPECT_FALSE(look_over.is_enough());
  look_over.add_scan(0);
  EXPECT_TRUE(look_over.is_enough());
}

TEST(LookOver, ends_after_many_scans_if_time_stands_still) {
  LookOver look_over(5);
  for (std::size_t i = 1; i < LookOver::kMostScans; ++i) look_over.add_scan(0);
  EXPECT_FALSE(look_over.is_enough());
  look_over.add_scan(0);
  EXPECT_TRUE(look_over.is_enough());
  EXPECT_FALSE(look_over.is_enough(true));
  while (!look_over.is_enough(true)) look_over.add_scan(0);
}

TEST(LookOver, awaits_a_laser_for_half_a_minute) {
  LookOver look_over(5);
  EXPECT_FALSE(look_over.is_enough(true));
  look_over.add_scan(0);
  look_over.add_scan(30 * kOneSecond - 1);
  EXPECT_FALSE(look_over.is_enough(true));
  look_over.add_scan(30 * kOneSecond);
  EXPECT_TRUE(look_over.is_enough(true));
  LookOver longer(40);
  longer.add_scan(0);
  longer.add_scan(35 * kOneSecond);
  EXPECT_FALSE(longer.is_enough(true));
}

}  // namespace
}  // namespace psi_slam
