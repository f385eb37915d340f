// SPDX-License-Identifier: BSD-3-Clause
#include "base/float_hypot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace psi_slam {
namespace {

TEST(FloatHypot, is_exact_where_the_length_is_a_float) {
  EXPECT_EQ(float_hypot(3, -4), 5);
  EXPECT_EQ(float_hypot(0, 0), 0);
  EXPECT_EQ(float_hypot(-0.1F, 0), 0.1F);
}

TEST(FloatHypot, neither_overflows_nor_underflows_in_between) {
  EXPECT_EQ(float_hypot(3e30F, 4e30F), 5e30F);
  EXPECT_EQ(float_hypot(1e-40F, 0), 1e-40F);
  EXPECT_EQ(float_hypot(std::numeric_limits<float>::infinity(), 1), std::numeric_limits<float>::infinity());
}

TEST(FloatHypot, is_the_float_nearest_to_the_length) {
  std::mt19937 random(1);
  const auto coordinate = [&] { return static_cast<float>(random()) / 1e8F - 20; };
  for (int i = 0; i < 100'000; ++i) {
    const float x = coordinate();
    const float y = coordinate();
    const long double length = std::hypot(static_cast<long double>(x), static_cast<long double>(y));
    EXPECT_EQ(float_hypot(x, y), static_cast<float>(length)) << x << ' ' << y;
  }
}

}  // namespace
}  // namespace psi_slam
