// SPDX-License-Identifier: BSD-3-Clause
#include "exports/run_summary.h"

#include <gtest/gtest.h>

#include <limits>

#include "psi_slam/grid_map.h"
#include "report/output_folder.h"
#include "simulated_room.h"

namespace psi_slam {
namespace {

RunSummary summary_of(const MappingResult& result) {
  return summarize_run(result, *draw_grid_map(result.log, mapped_poses(result)));
}

TEST(RunSummary, tells_what_was_read) {
  MappingResult result = walk_around_the_room();
  std::swap(result.log[10].time_us, result.log[11].time_us);
  const MappedLogFacts log = summary_of(result).log;
  EXPECT_EQ(log.scans, 50U);
  EXPECT_EQ(log.beams, 181U);
  EXPECT_NEAR(log.first_bearing_rad, -M_PI / 2, 1e-6);
  EXPECT_NEAR(log.duration_s, 49 * 0.2, 1e-9);
  EXPECT_EQ(log.stamps_back, 1U);
  EXPECT_EQ(log.returns, 1);
  EXPECT_NEAR(log.max_range_m, 30, 1e-6);
}

TEST(RunSummary, counts_the_returns_of_all_lasers) {
  MappingResult result = walk_around_the_room();
  for (std::size_t i = 0; i < 25; ++i) {
    CompanionScan blind;
    blind.scan = result.log[i].scan;
    blind.scan.laser = 1;
    blind.time_us = result.log[i].time_us;
    for (float& range_m : blind.scan.ranges_m) range_m = std::numeric_limits<float>::quiet_NaN();
    result.log[i].companions.push_back(blind);
  }
  const MappedLogFacts log = summary_of(result).log;
  EXPECT_EQ(log.companion_scans, 25U);
  EXPECT_NEAR(log.returns, 50.0 / 75, 1e-12);
}

TEST(RunSummary, counts_loops_and_like_reasons_together) {
  MappingResult result = walk_around_the_room();
  LoopRecord refused = result.loops[0];
  refused.refusal->value = 0.5;
  result.loops.push_back(refused);
  refused.refusal->reason = LoopRefusal::Reason::kContradicted;
  refused.verdict = LoopVerdict::kSwitchedOff;
  result.loops.push_back(refused);
  const LoopCounts loops = summary_of(result).loops;
  EXPECT_EQ(loops.accepted, 1U);
  EXPECT_EQ(loops.refused, 2U);
  EXPECT_EQ(loops.switched_off, 1U);
  ASSERT_EQ(loops.reasons.size(), 2U);
  EXPECT_EQ(loops.reasons[0].reason, LoopRefusal::Reason::kLowResponse);
  EXPECT_EQ(loops.reasons[0].count, 2U);
}

TEST(RunSummary, counts_attempts_that_found_nothing) {
  const MappingResult result = walk_around_the_room();
  const RunSummary summary = summary_of(result);
  EXPECT_EQ(summary.loops.tried, 12U);
  EXPECT_EQ(summary.loops.found, 2U);
  std::int64_t of_frames = 0;
  for (const FrameRecord& frame : result.frames) of_frames += frame.evaluations;
  EXPECT_EQ(summary.evaluations, of_frames + 200) << "and those of the last pass";
}

TEST(RunSummary, a_loop_still_pending_when_the_run_was_stopped_counts_as_refused) {
  MappingResult result = walk_around_the_room();
  result.loops[1].verdict = LoopVerdict::kPending;
  const LoopCounts loops = summary_of(result).loops;
  EXPECT_EQ(loops.refused, 2U);
  EXPECT_EQ(loops.accepted + loops.switched_off, 0U);
}

TEST(RunSummary, tells_speed_memory_and_map) {
  const RunSummary summary = summary_of(walk_around_the_room());
  EXPECT_NEAR(summary.real_time_factor, 9.8 / 0.5, 1e-9);
  EXPECT_GT(summary.peak_memory_mib, 1);
  EXPECT_EQ(summary.nodes, 10U);
  EXPECT_EQ(summary.local_maps, 2U);
  EXPECT_NEAR(summary.map.x_min_m, -2, 0.11);
  EXPECT_NEAR(summary.map.y_max_m, 3, 0.11);
  EXPECT_NEAR(summary.map.free_m2, 6 * 4, 1.5);
  EXPECT_NEAR(summary.path_length_m, 9.69, 0.4) << "around an ellipse of 2 m by 1 m, but for its last step";
}

TEST(RunSummary, tells_when_the_map_is_coarser_than_asked_for) {
  const MappingResult result = walk_around_the_room();
  const auto text_of = [&](const GridMapOptions& asked) {
    const auto grid = draw_grid_map(result.log, mapped_poses(result), asked);
    return coarser_cells_text(summarize_run(result, *grid, asked).map).value_or("");
  };
  GridMapOptions asked;
  EXPECT_EQ(text_of(asked), "");
  asked.resolution_m = 0.1;
  EXPECT_EQ(text_of(asked), "");
  asked.max_cells = 1000;
  EXPECT_EQ(text_of(asked), "map.max_cells leaves no room for cells of 0.1 m: those of the map are 0.2 m");
}

TEST(RunSummary, a_robot_that_trembles_goes_nowhere) {
  std::vector<mrpt::math::TPose2D> poses;
  for (int i = 0; i < 1000; ++i) poses.emplace_back(i % 2 == 0 ? 0.03 : 0, 0, 0);
  EXPECT_NEAR(path_length_m(poses), 0.03, 1e-9);
  poses.clear();
  for (int i = 0; i <= 1000; ++i) poses.emplace_back(0.01 * i, 0, 0);
  EXPECT_NEAR(path_length_m(poses), 10, 1e-9);
  EXPECT_EQ(path_length_m({}), 0);
}

TEST(RunSummary, an_empty_run_has_zeros) {
  const RunSummary summary = summary_of({});
  EXPECT_EQ(summary.log.scans, 0U);
  EXPECT_EQ(summary.real_time_factor, 0);
  EXPECT_EQ(summary.mean_response, 0);
}

}  // namespace
}  // namespace psi_slam
