// SPDX-License-Identifier: BSD-3-Clause
#include "base/random_draws.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(RandomDraws, seed_name_and_part_identify_a_stream) {
  const auto first = [](std::uint64_t seed, const char* name, std::uint32_t part) {
    return RandomDraws(seed, name, part).share();
  };
  EXPECT_EQ(first(1, "intel", 0), first(1, "intel", 0));
  EXPECT_NE(first(1, "intel", 0), first(2, "intel", 0));
  EXPECT_NE(first(1, "intel", 0), first(std::uint64_t{1} << 32, "intel", 0));
  EXPECT_NE(first(1, "intel", 0), first(1, "aces", 0));
  EXPECT_NE(first(1, "intel", 0), first(1, "intel", 1));
}

TEST(RandomDraws, normal_draws_have_their_moments) {
  RandomDraws draws(1, "", 0);
  constexpr int kDraws = 100'000;
  double sum = 0;
  double squares = 0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = draws.normal();
    sum += value;
    squares += value * value;
    beyond_two += std::abs(value) > 2 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.02);
  EXPECT_NEAR(squares / kDraws, 1, 0.02);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kDraws, 0.0455, 0.003);
}

TEST(RandomDraws, shares_and_indices_stay_in_their_bounds) {
  RandomDraws draws(7, "bounds", 3);
  for (int i = 0; i < 10'000; ++i) {
    EXPECT_LT(draws.index(3), 3U);
    EXPECT_LE(std::abs(draws.plus_minus(0.5)), 0.5);
  }
}

TEST(MixedBits, equal_the_numbers_of_split_mix_64) {  // the first two numbers published for seed 0
  EXPECT_EQ(mixed_bits(0), 0xe220a8397b1dcdafU);
  EXPECT_EQ(mixed_bits(0x9e3779b97f4a7c15), 0x6e789e6aa1b965f4U);
}

}  // namespace
}  // namespace psi_slam
