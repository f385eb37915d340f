// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/path_suspects.h"

#include <gtest/gtest.h>

#include "two_passes.h"

namespace psi_slam {
namespace {

TEST(PathSuspects, are_unmatched_stretches_with_their_motion) {
  MappingResult result = two_passes();
  EXPECT_TRUE(path_suspects(result).empty());
  for (std::size_t i = 20; i < 25; ++i) result.frames[i].match = ScanMatch::kUnmatched;
  result.frames[60].match = ScanMatch::kUnmatched;  // moves less than the least doubt
  const std::vector<PathSuspect> suspects = path_suspects(result, 0.5);
  ASSERT_EQ(suspects.size(), 1U);
  EXPECT_EQ(suspects[0].kind, PathSuspect::Kind::kUnmatched);
  EXPECT_EQ(suspects[0].first_frame, 20U);
  EXPECT_EQ(suspects[0].last_frame, 24U);
  EXPECT_GT(suspects[0].doubt_m, 1);
}

TEST(PathSuspects, are_interruptions) {
  MappingResult result = two_passes();
  result.interruptions = {{30, 35}, {50, std::nullopt}};
  const std::vector<PathSuspect> suspects = path_suspects(result);
  ASSERT_EQ(suspects.size(), 2U);
  EXPECT_EQ(suspects[0].kind, PathSuspect::Kind::kLost);
  EXPECT_EQ(suspects[0].last_frame, 35U);
  EXPECT_EQ(suspects[1].kind, PathSuspect::Kind::kUnplaced);
}

TEST(PathSuspects, are_gaps_of_the_log) {
  MappingResult result = two_passes();
  for (std::size_t i = 45; i < result.frames.size(); ++i) result.frames[i].time_us += 3'000'000;
  const std::vector<PathSuspect> suspects = path_suspects(result);
  ASSERT_EQ(suspects.size(), 1U);
  EXPECT_EQ(suspects[0].kind, PathSuspect::Kind::kGap);
  EXPECT_EQ(suspects[0].first_frame, 45U);
  result.later_run_frames = {45};
  EXPECT_TRUE(path_suspects(result).empty()) << "a new run begins there";
}

}  // namespace
}  // namespace psi_slam
