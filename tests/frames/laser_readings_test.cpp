// SPDX-License-Identifier: BSD-3-Clause
#include "frames/laser_readings.h"

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

TEST(LaserReadings, equal_the_maximum_if_written_alike) {
  std::vector<float> ranges_m{81.83F, 81.82F};
  mark_no_returns(ranges_m, 0, 81.83);
  EXPECT_TRUE(std::isinf(ranges_m[0]));
  EXPECT_TRUE(std::isfinite(ranges_m[1]));
}

}  // namespace
}  // namespace psi_slam
