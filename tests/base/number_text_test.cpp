// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

namespace psi_slam {
namespace {

TEST(NumberText, has_the_requested_number_of_decimals) {
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

TEST(NumberText, whole_numbers_lie_in_their_range) {
  EXPECT_EQ(parse_whole_number("0", 232), 0U);
  EXPECT_EQ(parse_whole_number("232", 232), 232U);
  for (const char* const text : {"233", "-1", "1.5", "", "x", "1e30", "nan"})
    EXPECT_FALSE(parse_whole_number(text, 232)) << text;
}

TEST(NumberText, does_not_depend_on_the_locale) {
  const char* german = std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
  if (german == nullptr) GTEST_SKIP() << "this system has no German locale";
  EXPECT_EQ(fixed_text(0.5, 1), "0.5");
  std::setlocale(LC_NUMERIC, "C");
}

std::uint64_t bits(double value) {
  std::uint64_t result = 0;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

double any_finite(std::mt19937_64& random) {
  while (true) {
    const std::uint64_t drawn = random();
    double value = 0;
    std::memcpy(&value, &drawn, sizeof value);
    if (std::isfinite(value)) return value;
  }
}

TEST(ExactNumber, keeps_every_bit_of_a_number) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const double value = any_finite(random);
    ASSERT_EQ(bits(parse_number(exact_text(value)).value()), bits(value)) << exact_text(value);
  }
}

TEST(ExactNumber, keeps_every_bit_of_an_angle) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> usual(-7, 7);
  for (int i = 0; i < 20'000; ++i) {
    const double radians = usual(random);
    ASSERT_EQ(bits(parse_degrees(exact_degrees_text(radians)).value()), bits(radians));
  }
  for (int i = 0; i < 2'000; ++i) {
    // Without the division, the largest angles would exceed the range of a double in degrees.
    const double radians = any_finite(random) / 64;
    ASSERT_EQ(bits(parse_degrees(exact_degrees_text(radians)).value()), bits(radians))
        << exact_degrees_text(radians);
  }
  for (const double radians : {0.0, -0.0, M_PI, -M_PI, M_PI / 2, 2 * M_PI, 0.07})
    EXPECT_EQ(bits(parse_degrees(exact_degrees_text(radians)).value()), bits(radians));
}

TEST(ExactNumber, a_typed_angle_is_printed_as_it_was_typed) {
  for (const char* text : {"0", "5", "-5", "90", "180", "360", "0.25", "12.5", "0.001", "57.3", "1000"})
    EXPECT_EQ(exact_degrees_text(parse_degrees(text).value()), text);
  EXPECT_EQ(parse_degrees("180"), M_PI);
}

TEST(ExactNumber, writes_the_shortest_text_without_exponent_for_usual_numbers) {
  EXPECT_EQ(exact_text(0.1), "0.1");
  EXPECT_EQ(exact_text(100000), "100000");
  EXPECT_EQ(exact_text(0.00002), "0.00002");
  EXPECT_EQ(exact_text(1e-9), "1e-09");
  EXPECT_EQ(exact_text(std::numeric_limits<double>::infinity()), "inf");
}

TEST(ExactNumber, reads_numbers_as_people_write_them) {
  EXPECT_EQ(parse_number("12"), 12);
  EXPECT_EQ(parse_number("+.5"), 0.5);
  EXPECT_EQ(parse_number("-1.5e-3"), -0.0015);
}

TEST(ExactNumber, rejects_other_texts) {
  for (const char* text : {"", "+", "-", "12abc", "abc", "1,5", "1 2", " 1", "1 ", "nan", "-nan", "inf",
                           "+inf", "infinity", "1e999", "0x10", "--1", "+-1", "1.2.3"}) {
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
    EXPECT_EQ(parse_degrees(text), std::nullopt) << text;
  }
}

TEST(MinutesText, has_hours_from_one_hour_on) {
  EXPECT_EQ(minutes_text(0.4), "0:00");
  EXPECT_EQ(minutes_text(59.6), "1:00");
  EXPECT_EQ(minutes_text(3599), "59:59");
  EXPECT_EQ(minutes_text(3600), "1:00:00");
  EXPECT_EQ(minutes_text(36000 + 62), "10:01:02");
}

TEST(Counted, has_the_plural_unless_there_is_one) {
  EXPECT_EQ(counted(1, "loop"), "1 loop");
  EXPECT_EQ(counted(0, "loop"), "0 loops");
}

}  // namespace
}  // namespace psi_slam
