// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/option_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psi_slam {
namespace {

TEST(NumberRange, includes_or_excludes_its_ends) {
  EXPECT_TRUE(between(0, 1).contains(0));
  EXPECT_TRUE(between(0, 1).contains(1));
  EXPECT_FALSE(between(0, 1).contains(std::nextafter(1, 2)));
  EXPECT_FALSE(above(0).contains(0));
  EXPECT_TRUE(above(0).contains(std::numeric_limits<double>::denorm_min()));
  EXPECT_FALSE(at_least(0).below(360).contains(360));
  EXPECT_TRUE(any_number().contains(-1e300));
}

TEST(NumberRange, contains_only_finite_numbers) {
  EXPECT_FALSE(any_number().contains(std::nan("")));
  EXPECT_FALSE(at_least(0).contains(std::numeric_limits<double>::infinity()));
}

TEST(NumberRange, has_words) {
  EXPECT_EQ(between(0.01, 20).words(), "between 0.01 and 20");
  EXPECT_EQ(at_least(1).words(), "1 or more");
  EXPECT_EQ(above(0).words(), "above 0");
  EXPECT_EQ(any_number().at_most(5).words(), "5 or less");
  EXPECT_EQ(any_number().below(5).words(), "below 5");
  EXPECT_EQ(above(0).at_most(20).words(), "above 0 and at most 20");
  EXPECT_EQ(above(0).below(1).words(), "above 0 and below 1");
  EXPECT_EQ(at_least(0).below(360).words(), "at least 0 and below 360");
  EXPECT_EQ(any_number().words(), "");
}

}  // namespace
}  // namespace psi_slam
