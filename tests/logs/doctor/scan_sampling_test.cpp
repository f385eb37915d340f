// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/scan_sampling.h"

#include <gmock/gmock.h>

#include "log_files.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;

std::vector<FrameMark> marks_of(const std::vector<TPose2D>& poses) {
  std::vector<FrameMark> marks;
  for (const TPose2D& pose : poses) marks.push_back({static_cast<TimeUs>(marks.size()) * 200'000, pose});
  return marks;
}

std::vector<FrameMark> marks_of_run(const std::vector<RunPart>& parts) {
  return marks_of(simulated_run(parts).truth);
}

TEST(ScanSampling, spreads_starts_over_motion_in_any_unit) {
  const auto metres = marks_of_run({{0, 0, 500}, {0.1, 0, 100}, {0, 0, 500}, {0.1, 0, 100}, {0, 0, 500}});
  auto millimetres = metres;
  for (FrameMark& mark : millimetres) mark.odom_T_robot.x *= 1000;
  const auto starts = frames_in_motion(metres, 20);
  EXPECT_EQ(starts, frames_in_motion(millimetres, 20));
  ASSERT_EQ(starts.size(), 20U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_GE(starts[i], 500U);
    EXPECT_LE(starts[i], 600U);
    EXPECT_GE(starts[i + 10], 1100U);
    EXPECT_LE(starts[i + 10], 1200U);
  }
}

TEST(ScanSampling, spreads_starts_over_time_if_odometry_is_constant) {
  EXPECT_THAT(frames_in_motion(marks_of_run({{0, 0, 99}}), 4), ElementsAre(12, 37, 61, 86));
  EXPECT_TRUE(frames_in_motion(marks_of_run({}), 4).empty());
}

TEST(ScanSampling, pairs_frames_by_distance_or_turn) {
  const auto pairs =
      pairs_by_motion(marks_of_run({{0.1, 0, 10}, {0, 3, 10}}), 0.25, mrpt::DEG2RAD(10.0), 100);
  ASSERT_GE(pairs.size(), 5U);
  EXPECT_EQ(pairs[0].first, 0U);
  EXPECT_EQ(pairs[0].second, 3U);
  EXPECT_EQ(pairs[1].first, 3U);
  EXPECT_EQ(pairs.back().second - pairs.back().first, 4U) << "four steps of 3 degrees";
  EXPECT_EQ(pairs_by_motion(marks_of_run({{0.1, 0, 1000}}), 0.25, 1, 7).size(), 7U);
}

TEST(ScanSampling, pairs_that_overlap_begin_where_the_robot_moves) {
  // 20 steps of 6 cm, a rest, and 20 more steps.
  const auto pairs =
      overlapping_pairs(marks_of_run({{0.06, 0, 20}, {0, 0, 50}, {0.06, 0, 20}}), 0.25, 1, 100);
  ASSERT_EQ(pairs.size(), 36U);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(pairs[i].first, i);
    EXPECT_EQ(pairs[i].second, i + 5);
  }
  EXPECT_EQ(pairs.back().second, 90U);
}

TEST(ScanSampling, pairs_frames_by_turns_on_the_spot) {
  const auto pairs = pairs_by_turn(marks_of_run({{0.1, 0, 50}, {0, 2, 30}, {0.1, 0, 50}}),
                                   mrpt::DEG2RAD(10.0), mrpt::DEG2RAD(45.0), 0.5, 100);
  ASSERT_FALSE(pairs.empty());
  for (const FramePair& pair : pairs) {
    EXPECT_GE(pair.second, 50U);
    EXPECT_LE(pair.first, 80U);
  }
}

TEST(ScanSampling, finds_places_that_odometry_revisits) {
  const auto there_and_back = marks_of_run({{0.1, 0, 200}, {-0.1, 0, 200}});
  const auto pairs = revisiting_pairs(there_and_back, 0.5, 0.5, 10, 100);
  ASSERT_GE(pairs.size(), 15U);
  for (const FramePair& pair : pairs) {
    EXPECT_LT(odometry_between(there_and_back, pair).norm(), 0.5);
    EXPECT_GE(pair.second - pair.first, 100U);
  }
  EXPECT_TRUE(revisiting_pairs(there_and_back, 0.5, 0.5, 50, 100).empty());
  EXPECT_TRUE(
      revisiting_pairs(marks_of_run({{0.1, 0, 200}, {0, 3, 60}, {0.1, 0, 200}}), 0.5, 0.5, 10, 100).empty())
      << "the headings are opposite";
}

TEST(ScanSampling, finds_full_turns_in_both_directions) {
  for (const double turn_deg : {5.0, -5.0}) {
    const auto marks = marks_of_run({{0.1, 0, 30}, {0, turn_deg, 75}, {0.1, 0, 30}});
    const auto turns = full_turns(marks, 0.4, 1.5, 10);
    ASSERT_EQ(turns.size(), 1U);
    EXPECT_GE(turns[0].size(), 12U);
    const auto headings_rad = unwrapped_headings(marks);
    const double turned_rad = headings_rad[turns[0].back()] - headings_rad[turns[0].front()];
    EXPECT_NEAR(std::abs(turned_rad), 2 * M_PI, 0.05);
  }
  EXPECT_TRUE(full_turns(marks_of_run({{0, 5, 60}}), 0.4, 1.5, 10).empty()) << "300 degrees are no full turn";
  EXPECT_TRUE(full_turns(marks_of_run({{0.1, 5, 80}}), 0.4, 1.0, 10).empty()) << "the turn is wider than 1 m";
}

TEST(ScanSampling, fetches_the_wanted_scans) {
  const TemporaryFolder folder;
  const SimulatedRun run = simulated_run({{0.1, 0, 20}});
  write_file(folder.path() / "log", carmen_log(run));
  ScanLibrary library;
  library.want(std::vector<std::size_t>{3, 17});
  library.want(std::vector<FramePair>{{0, 3}});
  library.fetch(folder.path() / "log", {});
  for (const std::size_t i : {0, 3, 17}) EXPECT_NEAR(library.at(i).ranges_m[90], run.ranges_m(i)[90], 0.001);
  EXPECT_THROW(library.at(4), std::out_of_range);
}

}  // namespace
}  // namespace psi_slam
