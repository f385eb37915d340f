// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.h"

#include <gtest/gtest.h>

#include <clocale>
#include <limits>

namespace psi_slam {
namespace {

TEST(NumberText, has_as_many_decimals_as_asked_for) {
  EXPECT_EQ(fixed_text(0.5, 3), "0.500");
  EXPECT_EQ(fixed_text(-1234.56789, 2), "-1234.57");
  EXPECT_EQ(fixed_text(1e20, 0), "100000000000000000000");
  EXPECT_EQ(fixed_text(1e-12, 4), "0.0000");
  EXPECT_EQ(fixed_text(std::numeric_limits<double>::quiet_NaN(), 3), "nan");
  EXPECT_GT(fixed_text(-std::numeric_limits<double>::max(), 20).size(), 300u);
}

TEST(NumberText, the_shortest_text_of_a_float_reads_back_as_that_float) {
  EXPECT_EQ(shortest_text(1.23F), "1.23");
  EXPECT_EQ(shortest_text(81.83F), "81.83");
  EXPECT_EQ(shortest_text(0.00001F), "0.00001");
  EXPECT_EQ(std::stof(shortest_text(1.0F / 3.0F)), 1.0F / 3.0F);
}

TEST(NumberText, does_not_care_for_the_locale) {
  const char* german = std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
  if (german == nullptr) GTEST_SKIP() << "this system has no German locale";
  EXPECT_EQ(fixed_text(0.5, 1), "0.5");
  std::setlocale(LC_NUMERIC, "C");
}

}  // namespace
}  // namespace psi_slam
