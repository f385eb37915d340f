// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/time_stamp.h"

#include <gtest/gtest.h>

#include <random>

namespace psi_slam {
namespace {

TEST(TimeStamp, keeps_every_microsecond_both_ways) {
  std::mt19937_64 random(7);
  std::uniform_int_distribution<TimeUs> draw(-2'000'000'000'000'000, 2'000'000'000'000'000);
  for (int i = 0; i < 10'000; ++i) {
    const TimeUs time_us = draw(random);
    EXPECT_EQ(parse_seconds(format_seconds(time_us)), time_us);
  }
}

TEST(TimeStamp, reads_what_logs_contain) {
  EXPECT_EQ(parse_seconds("976052905.167303"), 976052905167303);
  EXPECT_EQ(parse_seconds("90.2396"), 90239600);
  EXPECT_EQ(parse_seconds("12"), 12000000);
  EXPECT_EQ(parse_seconds("0.1234567"), 123457) << "rounded by the seventh decimal";
  EXPECT_EQ(parse_seconds("0.12345649"), 123456) << "the eighth decimal has no effect";
  EXPECT_EQ(parse_seconds("-0.25"), -250000);
  EXPECT_EQ(parse_seconds("1.5e3"), 1500000000);
}

TEST(TimeStamp, rejects_other_texts) {
  for (const char* text :
       {"", ".", "-", "abc", "1.2.3", "12 ", "nan", "inf", "1e300", "99999999999999999999"})
    EXPECT_EQ(parse_seconds(text), std::nullopt) << text;
}

TEST(TimeStamp, rejects_milliseconds_that_are_written_as_seconds) {
  for (const char* text : {"976052905167.303", "-976052905167", "9.7e11", "100000000000", "1e11"})
    EXPECT_EQ(parse_seconds(text), std::nullopt) << text;
  EXPECT_EQ(parse_seconds("99999999999.9999999"), kMostTimeUs);
  EXPECT_TRUE(is_possible_time(-kMostTimeUs));
  EXPECT_FALSE(is_possible_time(kMostTimeUs + 1));
}

}  // namespace
}  // namespace psi_slam
