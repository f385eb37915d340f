// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/map_verdict.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "two_passes.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

TEST(MapVerdict, finds_a_map_good_whose_passes_agree) {
  const MapVerdict verdict = judge_map(two_passes());
  EXPECT_EQ(verdict.state, MapState::kGood);
  EXPECT_TRUE(verdict.hot_spots.empty());
  EXPECT_LT(verdict.error_m, 0.02);
  EXPECT_GT(verdict.checked_share, 0.8);
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("the map is good"));
}

TEST(MapVerdict, points_at_a_doubled_wall) {
  const MapVerdict verdict = judge_map(two_passes({0.3, 0, 0}));
  EXPECT_NE(verdict.state, MapState::kGood);
  ASSERT_FALSE(verdict.hot_spots.empty());
  const HotSpot& worst = verdict.hot_spots.front();
  EXPECT_EQ(worst.kind, HotSpot::Kind::kDoubledWall);
  EXPECT_NEAR(worst.error_m, 0.3, 0.1);
  const double to_wall_m = std::min({std::abs(worst.at.x - -2), std::abs(worst.at.x - 4)});
  EXPECT_LT(to_wall_m, 0.5) << "at the walls that are displaced along their normals";
  EXPECT_THAT(hot_spot_text(worst), HasSubstr("doubled wall at ("));
  EXPECT_THAT(advice_text(worst), HasSubstr("by hand"));
}

TEST(MapVerdict, suspects_the_step_where_the_passes_part) {
  const MapVerdict verdict = judge_map(two_passes({0.3, 0, 0}));
  ASSERT_FALSE(verdict.hot_spots.empty());
  const Suspect& suspect = verdict.hot_spots.front().suspect;
  EXPECT_EQ(suspect.kind, Suspect::Kind::kStretch);
  EXPECT_LE(suspect.first_frame, kScansPerRound);
  EXPECT_GE(suspect.last_frame, kScansPerRound - 1);
  EXPECT_LT(suspect.last_frame - suspect.first_frame, 12U);
}

TEST(MapVerdict, suspects_scans_without_a_match) {
  MappingResult result = two_passes({0.3, 0, 0});
  for (std::size_t i = kScansPerRound - 3; i < kScansPerRound; ++i)
    result.frames[i].match = ScanMatch::kUnmatched;
  const MapVerdict verdict = judge_map(result);
  ASSERT_FALSE(verdict.hot_spots.empty());
  EXPECT_EQ(verdict.hot_spots.front().suspect.kind, Suspect::Kind::kUnmatched);
  EXPECT_EQ(verdict.hot_spots.front().suspect.last_frame, kScansPerRound - 1U);
}

TEST(MapVerdict, suspects_the_loop_that_the_map_contradicts) {
  MappingResult result = two_passes({0.3, 0, 0});
  result.loops = {loop_between(result, 2, 42), loop_between(result, 10, 50, {2, 0, 0})};
  const MapVerdict verdict = judge_map(result);
  ASSERT_FALSE(verdict.hot_spots.empty());
  for (const HotSpot& spot : verdict.hot_spots) {
    EXPECT_EQ(spot.suspect.kind, Suspect::Kind::kLoop);
    EXPECT_EQ(spot.suspect.loop, 1U);
    EXPECT_EQ(advice_text(spot), "delete the loop of scan 50 with local map 0");
  }
}

TEST(MapVerdict, names_runs_that_disagree) {
  MappingResult result = two_passes({0, 0.3, 0});
  result.later_run_frames = {kScansPerRound};
  const MapVerdict verdict = judge_map(result);
  ASSERT_FALSE(verdict.hot_spots.empty());
  EXPECT_EQ(verdict.hot_spots.front().kind, HotSpot::Kind::kRunsDisagree);
}

TEST(MapVerdict, finds_a_map_broken_with_a_run_beside_it) {
  MappingResult result = two_passes({30, 0, 0});
  result.later_run_frames = {kScansPerRound};
  result.interruptions = {{kScansPerRound, std::nullopt}};
  const MapVerdict verdict = judge_map(result);
  EXPECT_EQ(verdict.state, MapState::kBroken);
  ASSERT_FALSE(verdict.hot_spots.empty());
  EXPECT_EQ(verdict.hot_spots.front().kind, HotSpot::Kind::kUnplacedRun);
}

TEST(MapVerdict, says_that_nothing_was_checked) {
  const MapVerdict verdict = judge_map(MappingResult{});
  EXPECT_EQ(verdict.state, MapState::kGood);
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("no place was seen by two passes"));
}

}  // namespace
}  // namespace psi_slam
