// SPDX-License-Identifier: BSD-3-Clause
#include "frames/laser_readings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psi_slam {
namespace {

TEST(LaserReadings, mark_all_readings_but_returns) {
  const float inf = std::numeric_limits<float>::infinity();
  std::vector<float> ranges_m{1.5F, 0.0F, -2.0F, 8.0F, 7.999F, inf, -inf, std::nanf(""), 0.29F, 0.3F};
  mark_no_returns(ranges_m, 0.3, 8.0);
  const std::vector<bool> kept{true, false, false, false, true, false, false, false, false, true};
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(!std::isnan(ranges_m[i]), kept[i]) << i;
  EXPECT_EQ(ranges_m[0], 1.5F);
}

TEST(LaserReadings, equal_the_maximum_if_written_alike) {
  std::vector<float> ranges_m{81.83F, 81.82F};
  mark_no_returns(ranges_m, 0, 81.83);
  EXPECT_TRUE(std::isnan(ranges_m[0]));
  EXPECT_FALSE(std::isnan(ranges_m[1]));
}

}  // namespace
}  // namespace psi_slam
