// SPDX-License-Identifier: BSD-3-Clause
#include "batch/seed_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace psi_slam {
namespace {

TEST(SeedSpread, is_that_of_a_sample) {
  const SeedSpread spread = spread_of({1, 2, 6});
  EXPECT_DOUBLE_EQ(spread.mean, 3);
  EXPECT_DOUBLE_EQ(spread.std, std::sqrt(14.0 / 2));
  EXPECT_EQ(spread_text(spread, 1), "3.0 ± 2.6 [6.0]");
  EXPECT_EQ(spread_json(spread)["max"], 6);
}

TEST(SeedSpread, of_one_value_is_none) {
  EXPECT_EQ(spread_of({3}).std, 0);
  EXPECT_EQ(spread_text(spread_of({3}), 2), "3.00");
  EXPECT_EQ(spread_text(spread_of({}), 2), "–");
}

TEST(SeedSpread, rows_that_differ_by_their_seed_only_are_one_case) {
  struct Row {
    int name;
    std::uint64_t seed;
  };
  const auto cases = by_case(std::vector<Row>{{1, 4}, {1, 5}, {2, 4}},
                             [](const Row& a, const Row& b) { return a.name == b.name; });
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(seeds_of(cases[0]), (std::vector<std::uint64_t>{4, 5}));
  EXPECT_EQ(seeds_of(cases[1]), (std::vector<std::uint64_t>{4}));
}

}  // namespace
}  // namespace psi_slam
