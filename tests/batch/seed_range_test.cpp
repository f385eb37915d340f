// SPDX-License-Identifier: BSD-3-Clause
#include "batch/seed_range.h"

#include <gmock/gmock.h>

#include "test_files.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;

TEST(SeedRange, is_a_number_of_seeds_or_from_one_to_another) {
  EXPECT_THAT(parse_seeds("3").all(), ElementsAre(1, 2, 3));
  EXPECT_THAT(parse_seeds("4-6").all(), ElementsAre(4, 5, 6));
  EXPECT_THAT(parse_seeds("0-0").all(), ElementsAre(0));
  EXPECT_EQ(parse_seeds("1-1000000").count(), 1'000'000U);
  EXPECT_EQ(seeds_text(parse_seeds("1")), "seed 1");
  EXPECT_EQ(seeds_text(parse_seeds("2-4")), "seeds 2 to 4");
}

TEST(SeedRange, refuses_everything_else) {
  for (const char* text :
       {"", "0", "-1", "3-", "-", "3-2", "1-2-3", "some", "1.5", " 1", "1000001", "99999999999999999999"})
    EXPECT_THAT(sentence_of([&] { parse_seeds(text); }), testing::HasSubstr("--seeds: expected N")) << text;
}

}  // namespace
}  // namespace psi_slam
