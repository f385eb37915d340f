// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/decade_axis.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(DecadeAxis, places_each_decade_at_the_same_distance) {
  const DecadeAxis axis{0.01, 100};
  EXPECT_NEAR(axis.share(0.01), 0, 1e-12);
  EXPECT_NEAR(axis.share(0.1), 0.25, 1e-12);
  EXPECT_NEAR(axis.share(1), 0.5, 1e-12);
  EXPECT_NEAR(axis.share(100), 1, 1e-12);
}

TEST(DecadeAxis, keeps_values_beyond_its_ends_at_the_ends) {
  const DecadeAxis axis{0.1, 10};
  for (const double low : {0.05, 0.0, -3.0}) EXPECT_EQ(axis.share(low), 0) << low;
  EXPECT_EQ(axis.share(11), 1);
}

TEST(DecadesAround, are_the_fewest_that_include_both_values) {
  const DecadeAxis axis = decades_around(0.02, 30);
  EXPECT_NEAR(axis.low, 0.01, 1e-12);
  EXPECT_NEAR(axis.high, 100, 1e-9);
  const DecadeAxis single = decades_around(10, 10);
  EXPECT_NEAR(single.low, 10, 1e-9);
  EXPECT_NEAR(single.high, 100, 1e-9) << "an axis has at least one decade";
}

TEST(DecadeTicks, label_each_power_of_ten) {
  const std::vector<AxisTick> ticks = decade_ticks({0.01, 10}, power_text);
  ASSERT_EQ(ticks.size(), 4U);
  EXPECT_EQ(ticks[0].label, "0.01");
  EXPECT_EQ(ticks[2].label, "1");
  EXPECT_EQ(ticks[3].label, "10");
}

TEST(PsiAxis, reaches_from_a_tenth_of_the_thresholds_to_the_largest_value) {
  const DecadeAxis axis = psi_axis(250, {1, 6});
  EXPECT_NEAR(axis.low, 0.1, 1e-12);
  EXPECT_NEAR(axis.high, 1000, 1e-6);
  EXPECT_NEAR(psi_axis(0, {1, 1}).high, 1, 1e-12) << "thresholds are on the axis without any loop";
  EXPECT_NEAR(psi_axis(0, {1, 40}).high, 100, 1e-9);
  EXPECT_NEAR(psi_axis(5, {0.03, 6}).low, 0.001, 1e-12);
  EXPECT_NEAR(psi_axis(5, {0, 0}).low, 0.1, 1e-12) << "a threshold of 0 has no place on the axis";
  EXPECT_GE(psi_axis(1, {1e-300, 1}).low, 1e-7);
}

TEST(PsiTicks, say_that_smaller_values_lie_on_the_lowest_line) {
  const std::vector<AxisTick> ticks = psi_ticks({0.1, 10});
  ASSERT_EQ(ticks.size(), 3U);
  EXPECT_EQ(ticks[0].label, "≤ 0.1");
  EXPECT_EQ(ticks[1].label, "1");
}

}  // namespace
}  // namespace psi_slam
