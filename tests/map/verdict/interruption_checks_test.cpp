// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/interruption_checks.h"

#include <gtest/gtest.h>

#include "two_passes.h"

namespace psi_slam {
namespace {

/// Share by which the second round contradicts the first, after a gap or an interruption between them.
double contradiction_of(MappingResult result, PathSuspect::Kind kind,
                        const std::vector<FrameSpan>& explained = {}) {
  const std::vector<MapView> views = map_views(result);
  PassCheckOptions options;
  options.pass_apart_m = 4;
  const std::vector<PassCheck> checks = check_passes(views, options);
  const PathSuspect suspect{kind, kScansPerRound, kScansPerRound, 0};
  const auto found = check_interruptions(result, views, checks, {suspect}, explained, options);
  EXPECT_EQ(found.size(), 1U);
  return found.empty() ? 0 : found.front().contradicted;
}

TEST(InterruptionChecks, find_no_contradiction_if_the_passes_agree) {
  EXPECT_LT(contradiction_of(two_passes(), PathSuspect::Kind::kLost), 0.02);
  EXPECT_LT(contradiction_of(two_passes(), PathSuspect::Kind::kGap), 0.02);
}

TEST(InterruptionChecks, find_passes_that_contradict_each_other) {
  EXPECT_GT(contradiction_of(two_passes({0.5, 0, 0}), PathSuspect::Kind::kLost), 0.1);
}

TEST(InterruptionChecks, leave_out_what_another_stretch_explains) {
  const std::vector<FrameSpan> slip{{kScansPerRound - 3, kScansPerRound + 1}};
  EXPECT_EQ(contradiction_of(two_passes({0.5, 0, 0}), PathSuspect::Kind::kLost, slip), 0);
}

TEST(InterruptionChecks, compare_the_scans_on_both_sides_of_a_gap) {
  MappingResult result = two_passes();
  for (float& range_m : result.log[kScansPerRound].scan.ranges_m) range_m *= 1.5F;  // another room
  EXPECT_GT(contradiction_of(result, PathSuspect::Kind::kGap), 0.2);
  EXPECT_LT(contradiction_of(result, PathSuspect::Kind::kLost), 0.15) << "the robot may be elsewhere";
}

TEST(InterruptionChecks, check_only_interruptions_and_gaps) {
  const MappingResult result = two_passes();
  const std::vector<MapView> views = map_views(result);
  const PathSuspect unmatched{PathSuspect::Kind::kUnmatched, 5, 9, 1};
  const PathSuspect unplaced{PathSuspect::Kind::kUnplaced, 20, 20, 0};
  EXPECT_TRUE(check_interruptions(result, views, check_passes(views), {unmatched, unplaced}, {}).empty());
}

}  // namespace
}  // namespace psi_slam
