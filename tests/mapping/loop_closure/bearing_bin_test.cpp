// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/bearing_bin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psi_slam {
namespace {

TEST(BearingBin, is_that_of_the_exact_bearing_but_at_edges) {
  constexpr int kDirections = 1'000'000;
  for (int i = 0; i < kDirections; ++i) {
    const double bearing_deg = 360.0 * (i + 0.5) / kDirections;
    const double from_edge = std::abs(bearing_deg - std::round(bearing_deg));
    if (from_edge < 0.001) continue;
    const double bearing_rad = bearing_deg * M_PI / 180;
    const double range_m = 0.01 + i % 97;
    ASSERT_EQ(bearing_bin(range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad)),
              static_cast<std::size_t>(bearing_deg))
        << bearing_deg;
  }
}

TEST(BearingBin, has_a_value_for_every_point) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(bearing_bin(0, 0), 0U);
  EXPECT_EQ(bearing_bin(kInfinity, -kInfinity), 0U);
  EXPECT_EQ(bearing_bin(std::nan(""), std::nan("")), 0U);
  EXPECT_EQ(bearing_bin(1, 0), 0U);
  EXPECT_EQ(bearing_bin(0, 1), 90U);
  EXPECT_EQ(bearing_bin(-1, 0), 180U);
  EXPECT_EQ(bearing_bin(0, -1), 270U);
  EXPECT_EQ(bearing_bin(1, -1e-300), kBearingBins - 1);
}

}  // namespace
}  // namespace psi_slam
