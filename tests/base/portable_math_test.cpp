// SPDX-License-Identifier: BSD-3-Clause
#include "base/portable_math.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace psi_slam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A function of one number, beside the same function of <cmath> in long double.
struct Function {
  std::string name;
  std::function<double(double)> portable;
  std::function<long double(long double)> reference;
  double smallest;  // of the numbers to try
  double largest;
};

std::vector<Function> functions() {
  using Long = long double;
  return {{"sin", portable::sin, [](Long x) { return std::sin(x); }, -100, 100},
          {"cos", portable::cos, [](Long x) { return std::cos(x); }, -100, 100},
          {"tan", portable::tan, [](Long x) { return std::tan(x); }, -1.5, 1.5},
          {"asin", portable::asin, [](Long x) { return std::asin(x); }, -1, 1},
          {"acos", portable::acos, [](Long x) { return std::acos(x); }, -1, 1},
          {"atan", portable::atan, [](Long x) { return std::atan(x); }, -50, 50},
          {"exp", portable::exp, [](Long x) { return std::exp(x); }, -50, 50},
          {"log", portable::log, [](Long x) { return std::log(x); }, 1e-6, 1e6},
          {"log1p", portable::log1p, [](Long x) { return std::log1p(x); }, -0.99, 1e3},
          {"log2", portable::log2, [](Long x) { return std::log2(x); }, 1e-6, 1e6},
          {"log10", portable::log10, [](Long x) { return std::log10(x); }, 1e-6, 1e6}};
}

/// Returns how far `value` is from `exact`, in distances between `exact` as a double and the next double.
double units_in_last_place(double value, long double exact) {
  const auto nearest = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(nearest, kInfinity) - nearest;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact) /
                             static_cast<long double>(unit));
}

/// Numbers between two limits: the same for every standard library, unlike those of
/// std::uniform_real_distribution.
class Numbers {
 public:
  double operator()(double smallest, double largest) {
    return smallest + (largest - smallest) * (static_cast<double>(random_()) / 0x1p32);
  }

 private:
  std::mt19937 random_{1};
};

/// A number that depends on every bit of the doubles added to it (FNV-1a).
class Digest {
 public:
  void add(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    sum_ = (sum_ ^ bits) * 0x100000001b3U;
    sum_ ^= sum_ >> 32;
  }
  std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325U;
};

TEST(PortableMath, functions_of_one_number_are_accurate_to_the_last_place) {
  Numbers numbers;
  for (const Function& function : functions())
    for (int i = 0; i < 20'000; ++i) {
      const double number = numbers(function.smallest, function.largest);
      EXPECT_LE(units_in_last_place(function.portable(number), function.reference(number)), 1.0)
          << function.name << '(' << number << ')';
    }
}

TEST(PortableMath, sine_and_cosine_are_accurate_to_the_last_place) {
  Numbers numbers;
  for (int i = 0; i < 20'000; ++i) {
    const double angle_rad = numbers(-10, 10);
    const portable::SineCosine both = portable::sin_cos(angle_rad);
    EXPECT_LE(units_in_last_place(both.sin, std::sin(static_cast<long double>(angle_rad))), 1.0) << angle_rad;
    EXPECT_LE(units_in_last_place(both.cos, std::cos(static_cast<long double>(angle_rad))), 1.0) << angle_rad;
  }
}

TEST(PortableMath, functions_of_two_numbers_are_accurate) {
  Numbers numbers;
  for (int i = 0; i < 20'000; ++i) {
    const double x = numbers(-30, 30);
    const double y = numbers(-30, 30);
    const auto long_x = static_cast<long double>(x);
    const auto long_y = static_cast<long double>(y);
    EXPECT_LE(units_in_last_place(portable::atan2(y, x), std::atan2(long_y, long_x)), 3.5) << y << ' ' << x;
    EXPECT_LE(units_in_last_place(portable::hypot(x, y), std::hypot(long_x, long_y)), 1.5) << y << ' ' << x;
    const double base = numbers(0, 30);
    const double exponent = x / 10;
    EXPECT_LE(
        units_in_last_place(portable::pow(base, exponent),
                            std::pow(static_cast<long double>(base), static_cast<long double>(exponent))),
        1.0)
        << base << ' ' << exponent;
  }
}

TEST(PortableMath, right_angles_are_exact) {
  EXPECT_EQ(portable::atan2(0, 1), 0);
  EXPECT_EQ(portable::atan2(2, 0), M_PI / 2);
  EXPECT_EQ(portable::atan2(-2, 0), -M_PI / 2);
  EXPECT_EQ(portable::atan2(0, -3), M_PI);
  EXPECT_EQ(portable::atan2(0, 0), 0);
  EXPECT_EQ(portable::sin(0), 0);
  EXPECT_EQ(portable::cos(0), 1);
  EXPECT_EQ(portable::acos(-1), M_PI);
  EXPECT_EQ(portable::exp(0), 1);
  EXPECT_EQ(portable::log(1), 0);
  EXPECT_EQ(portable::pow(10, 3), 1000);
}

TEST(PortableMath, numbers_without_a_result_give_none) {
  EXPECT_TRUE(std::isnan(portable::sin(kInfinity)));
  EXPECT_TRUE(std::isnan(portable::asin(1.01)));
  EXPECT_TRUE(std::isnan(portable::log(-1)));
  EXPECT_TRUE(std::isnan(portable::hypot(std::nan(""), 1)));
  EXPECT_EQ(portable::log(0), -kInfinity);
  EXPECT_EQ(portable::exp(1000), kInfinity);
  EXPECT_EQ(portable::exp(-1000), 0);
  EXPECT_EQ(portable::hypot(kInfinity, 1), kInfinity);
}

TEST(PortableMath, results_are_the_same_to_the_last_bit_everywhere) {
  Numbers numbers;
  Digest digest;
  for (const Function& function : functions())
    for (int i = 0; i < 10'000; ++i)
      digest.add(function.portable(numbers(function.smallest, function.largest)));
  for (int i = 0; i < 10'000; ++i) {
    const double x = numbers(-30, 30);
    const double y = numbers(-30, 30);
    digest.add(portable::atan2(y, x));
    digest.add(portable::hypot(x, y));
    digest.add(portable::pow(std::abs(x), y / 10));
  }
  EXPECT_EQ(digest.value(),
            0xcbf4caae739992b4U);  // seen on Debian 12 (SLEEF 3.5.1) and on Debian 13 (SLEEF 3.6.1)
}

TEST(PortableMath, lengths_of_floats_are_exact_where_they_are_floats) {
  EXPECT_EQ(portable::hypot(3.0F, -4.0F), 5);
  EXPECT_EQ(portable::hypot(0.0F, 0.0F), 0);
  EXPECT_EQ(portable::hypot(-0.1F, 0.0F), 0.1F);
}

TEST(PortableMath, lengths_of_floats_neither_overflow_nor_underflow_in_between) {
  EXPECT_EQ(portable::hypot(3e30F, 4e30F), 5e30F);
  EXPECT_EQ(portable::hypot(1e-40F, 0.0F), 1e-40F);
  EXPECT_EQ(portable::hypot(std::numeric_limits<float>::infinity(), 1.0F),
            std::numeric_limits<float>::infinity());
}

TEST(PortableMath, lengths_of_floats_are_the_nearest_floats) {
  std::mt19937 random(1);
  const auto coordinate = [&] { return static_cast<float>(random()) / 1e8F - 20; };
  for (int i = 0; i < 100'000; ++i) {
    const float x = coordinate();
    const float y = coordinate();
    const long double length = std::hypot(static_cast<long double>(x), static_cast<long double>(y));
    EXPECT_EQ(portable::hypot(x, y), static_cast<float>(length)) << x << ' ' << y;
  }
}

}  // namespace
}  // namespace psi_slam
