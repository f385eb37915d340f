// SPDX-License-Identifier: BSD-3-Clause
#include "batch/seeds.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "test_files.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;

TEST(SeedRange, is_a_number_of_seeds_or_first_and_last) {
  EXPECT_THAT(parse_seeds("3").all(), ElementsAre(1, 2, 3));
  EXPECT_THAT(parse_seeds("4-6").all(), ElementsAre(4, 5, 6));
  EXPECT_THAT(parse_seeds("0-0").all(), ElementsAre(0));
  EXPECT_EQ(parse_seeds("1-1000000").count(), 1'000'000U);
  EXPECT_EQ(seeds_text(parse_seeds("1")), "seed 1");
  EXPECT_EQ(seeds_text(parse_seeds("2-4")), "seeds 2 to 4");
}

TEST(SeedRange, refuses_other_texts) {
  for (const char* text :
       {"", "0", "-1", "3-", "-", "3-2", "1-2-3", "some", "1.5", " 1", "1000001", "99999999999999999999"})
    EXPECT_THAT(sentence_of([&] { parse_seeds(text); }), testing::HasSubstr("--seeds: expected N")) << text;
}

TEST(SeedSpread, has_the_standard_deviation_of_a_sample) {
  const SeedSpread spread = spread_of({1, 2, 6});
  EXPECT_DOUBLE_EQ(spread.mean, 3);
  EXPECT_DOUBLE_EQ(spread.std, std::sqrt(14.0 / 2));
  EXPECT_EQ(spread_text(spread, 1), "3.0 ± 2.6 [6.0]");
  EXPECT_EQ(spread_json(spread)["max"], 6);
}

TEST(SeedSpread, of_one_value_is_only_the_mean) {
  EXPECT_EQ(spread_of({3}).std, 0);
  EXPECT_EQ(spread_text(spread_of({3}), 2), "3.00");
  EXPECT_EQ(spread_text(spread_of({}), 2), "–");
  EXPECT_TRUE(spread_json(spread_of({})).is_null());
}

TEST(SeedSpread, groups_rows_that_differ_only_in_their_seed) {
  struct NamedRun {
    int name;
    std::uint64_t seed;
  };
  const auto cases = by_case(std::vector<NamedRun>{{1, 4}, {1, 5}, {2, 4}},
                             [](const NamedRun& a, const NamedRun& b) { return a.name == b.name; });
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(seeds_of(cases[0]), (std::vector<std::uint64_t>{4, 5}));
  EXPECT_EQ(seeds_of(cases[1]), (std::vector<std::uint64_t>{4}));
}

}  // namespace
}  // namespace psi_slam
