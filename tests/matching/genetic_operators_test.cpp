// SPDX-License-Identifier: BSD-3-Clause
#include "matching/genetic_operators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace psi_slam {
namespace {

// Returns the chi-square statistic of counts against expected counts. All draws are seeded, so the tests are
// deterministic.
double chi_square(const std::vector<double>& counts, const std::vector<double>& expected) {
  double sum = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  return sum;
}

// Returns the limit that chi_square() exceeds by chance once in a million trials (approximation of Wilson and
// Hilferty). `z` is the corresponding quantile of the normal distribution.
double chi_square_limit(std::size_t categories, double z = 4.75) {
  const double degrees = static_cast<double>(categories - 1);
  const double a = 2 / (9 * degrees);
  return degrees * std::pow(1 - a + z * std::sqrt(a), 3);
}

TEST(GeneticOperators, the_limit_of_chi_square_equals_that_of_tables) {
  EXPECT_NEAR(chi_square_limit(11, 3.0902), 29.588, 0.3) << "10 degrees of freedom, p = 0.001";
}

TEST(GeneticOperators, each_seed_gives_one_generator) {
  const MatchSeed seed = {1, 2, 3};
  Random a = random_for(seed);
  Random b = random_for(seed);
  std::set<std::uint64_t> firsts = {a()};
  EXPECT_EQ(b(), *firsts.begin());
  for (const MatchSeed& other : {MatchSeed{2, 2, 3}, MatchSeed{1, 3, 3}, MatchSeed{1, 2, 4},
                                 MatchSeed{2, 1, 3}, MatchSeed{3, 2, 1}, MatchSeed{1ULL << 40, 2, 3}}) {
    Random random = random_for(other);
    EXPECT_TRUE(firsts.insert(random()).second);
  }
}

TEST(GeneticOperators, integers_are_drawn_uniformly) {
  Random random(1);
  for (const std::uint64_t count : {1U, 2U, 7U, 64U}) {
    const int draws = 100'000;
    std::vector<double> counts(count, 0);
    for (int i = 0; i < draws; ++i) ++counts.at(draw_below(count, random));
    if (count == 1) continue;
    EXPECT_LT(chi_square(counts, std::vector<double>(count, draws / static_cast<double>(count))),
              chi_square_limit(count));
  }
}

// For counts near 2^64, a plain modulus would draw small numbers more often.
TEST(GeneticOperators, large_ranges_are_drawn_uniformly_too) {
  Random random(2);
  const std::uint64_t count = 3ULL << 62;
  int low = 0;
  for (int i = 0; i < 30'000; ++i) low += draw_below(count, random) < (1ULL << 62) ? 1 : 0;
  EXPECT_NEAR(low, 10'000, 400);
}

TEST(GeneticOperators, unit_draws_fill_the_unit_interval) {
  Random random(3);
  std::vector<double> counts(10, 0);
  for (int i = 0; i < 100'000; ++i) {
    const double u = draw_unit(random);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    ++counts[static_cast<std::size_t>(10 * u)];
  }
  EXPECT_LT(chi_square(counts, std::vector<double>(10, 10'000)), chi_square_limit(10));
}

TEST(GeneticOperators, the_roulette_wheel_draws_in_proportion_to_fitness) {
  const std::vector<double> fitness = {0.1, 0.4, 0, 0.25, 0.05};
  const RouletteWheel wheel(fitness);
  Random random(4);
  const int spins = 100'000;
  std::vector<double> counts(fitness.size(), 0);
  for (int i = 0; i < spins; ++i) ++counts.at(wheel.spin(random));
  EXPECT_EQ(counts[2], 0) << "individuals without fitness are never drawn";
  std::vector<double> seen;
  std::vector<double> expected;
  for (const std::size_t i : {0U, 1U, 3U, 4U}) {
    seen.push_back(counts[i]);
    expected.push_back(spins * fitness[i] / 0.8);
  }
  EXPECT_LT(chi_square(seen, expected), chi_square_limit(seen.size()));
}

TEST(GeneticOperators, the_roulette_wheel_draws_uniformly_without_fitness) {
  const RouletteWheel wheel({0, 0, 0, 0});
  Random random(5);
  std::vector<double> counts(4, 0);
  for (int i = 0; i < 40'000; ++i) ++counts.at(wheel.spin(random));
  EXPECT_LT(chi_square(counts, std::vector<double>(4, 10'000)), chi_square_limit(4));
}

TEST(GeneticOperators, crossover_exchanges_one_run_of_bits_uniformly) {
  constexpr int kBits = 6;
  const Chromosome ones = (Chromosome{1} << kBits) - 1;
  Random random(6);
  std::map<Chromosome, double> runs;
  const int draws = 60'000;
  for (int i = 0; i < draws; ++i) {
    const auto [a, b] = two_point_crossover(0, ones, kBits, random);
    ASSERT_EQ(a ^ b, ones) << "the parents exchange bits";
    const Chromosome filled = a | (a - 1);  // fills the zeros below the run
    ASSERT_NE(a, 0U);
    ASSERT_EQ(filled & (filled + 1), 0U) << "the exchanged bits form one run";
    ++runs[a];
  }
  ASSERT_EQ(runs.size(), 21U) << "pairs of 7 cuts";
  std::vector<double> counts;
  for (const auto& [run, count] : runs) counts.push_back(count);
  EXPECT_LT(chi_square(counts, std::vector<double>(21, draws / 21.0)), chi_square_limit(21));
}

TEST(GeneticOperators, crossover_keeps_the_length_and_the_bits_of_each_position) {
  Random random(7);
  for (const int bits : {1, 2, 26, 63, 64}) {
    const Chromosome all = bits == 64 ? ~Chromosome{0} : (Chromosome{1} << bits) - 1;
    for (int i = 0; i < 200; ++i) {
      const Chromosome a = random() & all;
      const Chromosome b = random() & all;
      const auto [c, d] = two_point_crossover(a, b, bits, random);
      ASSERT_EQ(c & ~all, 0U);
      ASSERT_EQ(d & ~all, 0U);
      ASSERT_EQ(a ^ b, c ^ d);
      ASSERT_EQ(a & b, c & d);
    }
  }
}

TEST(GeneticOperators, mutation_flips_every_bit_at_its_rate_and_none_beyond) {
  constexpr int kBits = 26;
  Random random(8);
  const int draws = 20'000;
  const double rate = 0.1;
  std::vector<double> flips(kBits, 0);
  std::vector<double> flips_at_once(4, 0);
  for (int i = 0; i < draws; ++i) {
    const Chromosome mutant = mutate(0, kBits, rate, random);
    ASSERT_EQ(mutant >> kBits, 0U);
    std::size_t count = 0;
    for (int bit = 0; bit < kBits; ++bit) {
      if (((mutant >> bit) & 1) == 0) continue;
      ++flips[static_cast<std::size_t>(bit)];
      ++count;
    }
    ++flips_at_once[std::min<std::size_t>(3, count)];
  }
  // The variance of a binomial count is (1 - rate) times the variance of a multinomial count.
  EXPECT_LT(chi_square(flips, std::vector<double>(kBits, draws * rate)) / (1 - rate),
            chi_square_limit(kBits + 1));
  std::vector<double> expected;
  double more = 1;
  double ways = 1;
  for (int k = 0; k < 3; ++k) {
    expected.push_back(draws * ways * std::pow(rate, k) * std::pow(1 - rate, kBits - k));
    more -= expected.back() / draws;
    ways = ways * (kBits - k) / (k + 1);
  }
  expected.push_back(draws * more);
  EXPECT_LT(chi_square(flips_at_once, expected), chi_square_limit(4)) << "bits flip independently";
  EXPECT_EQ(mutate(0b1011, 4, 0, random), 0b1011U);
  EXPECT_EQ(mutate(0b1011, 4, 1, random), 0b0100U);
}

}  // namespace
}  // namespace psi_slam
