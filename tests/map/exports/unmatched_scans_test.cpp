// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/unmatched_scans.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

/// Result of a robot that drives 0.5 m between two scans, with two scans a second. '+' is a matched scan, '-'
/// an unmatched scan, '|' the first scan of a run.
MappingResult drive(const std::string& scans) {
  MappingResult result;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    FrameRecord record;
    record.time_us = 976052905'000000 + static_cast<TimeUs>(i) * 500'000;
    record.front_end_T_robot = {0.5 * static_cast<double>(i), 0, 0};
    record.match = scans[i] == '+'   ? ScanMatch::kMatched
                   : scans[i] == '-' ? ScanMatch::kUnmatched
                                     : ScanMatch::kNoMap;
    if (scans[i] == '|' && i > 0) result.later_run_frames.push_back(i);
    result.frames.push_back(record);
    result.log.emplace_back();
  }
  return result;
}

UnmatchedScans unmatched_of(const std::string& scans) {
  const MappingResult result = drive(scans);
  return unmatched_scans(result.frames, runs_of(result));
}

TEST(UnmatchedScans, are_joined_to_stretches) {
  const UnmatchedScans unmatched = unmatched_of("|++---+-");
  EXPECT_EQ(unmatched.count, 4U);
  ASSERT_EQ(unmatched.stretches.size(), 2U);
  const UnmatchedStretch& first = unmatched.stretches[0];
  EXPECT_EQ(first.first_frame, 3U);
  EXPECT_EQ(first.last_frame, 5U);
  EXPECT_EQ(first.first_time_us, 976052906'500000);
  EXPECT_EQ(first.last_time_us, 976052907'500000);
  EXPECT_NEAR(first.predicted_length_m, 1.5, 1e-9) << "the path starts at the last matched scan";
  EXPECT_EQ(unmatched.stretches[1].scans(), 1U) << "the last scan of the log";
  EXPECT_EQ(unmatched.stretches[1].first_frame, 7U);
}

TEST(UnmatchedScans, leave_out_scans_without_a_map_to_match_with) {
  EXPECT_EQ(unmatched_of("|+++|+").count, 0U);
  EXPECT_EQ(unmatched_of("|").count, 0U);
  EXPECT_EQ(unmatched_of("").count, 0U);
}

TEST(UnmatchedScans, of_two_runs_are_two_stretches) {
  const UnmatchedScans unmatched = unmatched_of("|+--|-+");
  ASSERT_EQ(unmatched.stretches.size(), 2U);
  EXPECT_EQ(unmatched.stretches[0].run, 0U);
  EXPECT_EQ(unmatched.stretches[0].last_frame, 3U);
  EXPECT_EQ(unmatched.stretches[1].run, 1U);
  EXPECT_EQ(unmatched.stretches[1].run_start_us, 976052907'000000);
}

/// Checks the stretches for each of the 256 patterns of eight matched or unmatched scans.
TEST(UnmatchedScans, cover_exactly_the_unmatched_scans) {
  for (int pattern = 0; pattern < 256; ++pattern) {
    std::string scans = "|";
    for (int bit = 0; bit < 8; ++bit) scans += (pattern >> bit & 1) != 0 ? '-' : '+';
    std::string covered(scans.size(), '+');
    covered[0] = '|';
    for (const UnmatchedStretch& stretch : unmatched_of(scans).stretches)
      for (std::size_t i = stretch.first_frame; i <= stretch.last_frame; ++i) covered[i] = '-';
    EXPECT_EQ(covered, scans);
  }
}

TEST(UnmatchedScansText, lists_the_stretches) {
  EXPECT_EQ(unmatched_scans_text(drive("|++---+-")),
            "4 of 8 scans matched no local map and were placed by odometry: at 1.5-2.5 s (3 scans, 1.5 m), "
            "3.5 s (1 scan, 0.5 m); the map may be wrong there");
  EXPECT_EQ(unmatched_scans_text(drive("|-+")),
            "1 of 3 scans matched no local map and was placed by odometry: at 0.5 s (1 scan, 0.5 m); the map "
            "may be wrong there");
  EXPECT_EQ(unmatched_scans_text(drive("|++")), std::nullopt);
  EXPECT_EQ(unmatched_scans_text({}), std::nullopt);
}

TEST(UnmatchedScansText, warns_only_of_stretches_that_the_verdict_does_not_confirm) {
  const MappingResult result = drive("|+-+---+");
  MapVerdict verdict;
  EXPECT_EQ(unmatched_scans_text(result, &verdict), unmatched_scans_text(result));
  verdict.confirmed_stretches = {{2, 3}};
  EXPECT_EQ(unmatched_scans_text(result, &verdict),
            "4 of 8 scans matched no local map and were placed by odometry, 3 of them where no other scans "
            "confirm the motion: at 2.0-3.0 s (3 scans, 1.5 m); the map may be wrong there");
  verdict.confirmed_stretches = {{2, 3}, {4, 7}};
  EXPECT_EQ(unmatched_scans_text(result, &verdict),
            "4 of 8 scans matched no local map and were placed by odometry: at 1.0 s (1 scan, 0.5 m), "
            "2.0-3.0 s (3 scans, 1.5 m); the scans before and after fit each other");
}

TEST(UnmatchedScansText, lists_the_five_longest_in_the_order_of_the_log) {
  EXPECT_EQ(unmatched_scans_text(drive("|-+-+---+-+-+--+-")),
            "10 of 17 scans matched no local map and were placed by odometry: at 0.5 s (1 scan, 0.5 m), "
            "1.5 s (1 scan, 0.5 m), 2.5-3.5 s (3 scans, 1.5 m), 4.5 s (1 scan, 0.5 m), 6.5-7.0 s (2 scans, "
            "1.0 m) and 2 more; the map may be wrong there");
}

TEST(UnmatchedScansText, names_runs_and_the_model_without_odometry) {
  MappingResult result = drive("|+|-");
  result.log.back().has_odometry = false;
  EXPECT_EQ(
      unmatched_scans_text(result),
      "1 of 4 scans matched no local map and was placed by the constant-velocity model: at 0.5 s of run "
      "2 (1 scan, 0.5 m); the map may be wrong there");
}

}  // namespace
}  // namespace psi_slam
