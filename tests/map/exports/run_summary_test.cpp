// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/run_summary.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "doubtful_map.h"
#include "map/exports/mapped_trajectory.h"
#include "psi_slam/grid_map.h"
#include "simulated_room.h"

namespace psi_slam {
namespace {

RunSummary summary_of(const MappingResult& result) {
  return summarize_run(result, *draw_grid_map(result.log, mapped_poses(result)));
}

TEST(RunSummary, describes_the_log) {
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

TEST(RunSummary, counts_loops_and_their_reasons) {
  MappingResult result = walk_around_the_room();
  LoopRecord rejected = result.loops[0];
  rejected.rejection->value = 0.5;
  result.loops.push_back(rejected);
  rejected.rejection->reason = LoopRejection::Reason::kContradicted;
  result.loops.push_back(rejected);
  const LoopCounts loops = summary_of(result).loops;
  EXPECT_EQ(loops.accepted, 1U);
  EXPECT_EQ(loops.rejected, 3U);
  ASSERT_EQ(loops.reasons.size(), 2U);
  EXPECT_EQ(loops.reasons[0].reason, LoopRejection::Reason::kLowResponse);
  EXPECT_EQ(loops.reasons[0].count, 2U);
}

TEST(RunSummary, counts_attempts_that_found_nothing) {
  const MappingResult result = walk_around_the_room();
  const RunSummary summary = summary_of(result);
  EXPECT_EQ(summary.loops.tried, 12U);
  EXPECT_EQ(summary.loops.found, 2U);
  std::int64_t of_frames = 0;
  for (const FrameRecord& frame : result.frames) of_frames += frame.evaluations;
  EXPECT_EQ(summary.evaluations, of_frames + 200) << "plus 200 evaluations of the final search";
}

TEST(RunSummary, counts_candidates_of_a_stopped_run_as_rejected) {
  MappingResult result = walk_around_the_room();
  result.loops[1].state = LoopState::kCandidate;
  const LoopCounts loops = summary_of(result).loops;
  EXPECT_EQ(loops.rejected, 2U);
  EXPECT_EQ(loops.accepted, 0U);
}

TEST(RunSummary, has_speed_memory_and_map) {
  const RunSummary summary = summary_of(walk_around_the_room());
  EXPECT_NEAR(summary.real_time_factor, 9.8 / 0.5, 1e-9);
  EXPECT_GT(summary.peak_memory_mib, 1);
  EXPECT_EQ(summary.nodes, 10U);
  EXPECT_EQ(summary.local_maps, 2U);
  EXPECT_NEAR(summary.map.x_min_m, -2, 0.11);
  EXPECT_NEAR(summary.map.y_max_m, 3, 0.11);
  EXPECT_NEAR(summary.map.free_m2, 6 * 4, 1.5);
  EXPECT_NEAR(summary.path_length_m, 9.69, 0.4) << "an ellipse of 2 m by 1 m without its last step";
}

TEST(RunSummary, reports_a_map_that_is_coarser_than_asked_for) {
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
  EXPECT_EQ(text_of(asked), "map.max_cells limits the map to cells of 0.2 m instead of 0.1 m");
}

TEST(RunSummary, ignores_the_jitter_of_a_robot_at_rest) {
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

RunSummary some_figures() {
  RunSummary summary;
  summary.log.scans = 50;
  summary.log.first_time_us = 976052905167303;
  summary.log.duration_s = 9.8;
  summary.loops.accepted = 1;
  summary.loops.reasons = {{LoopRejection::Reason::kLowResponse, 7}};
  summary.real_time_factor = 19.6;
  summary.peak_memory_mib = 123.4;
  summary.final_search_cut_short = true;
  summary.broken_off = "room.clf:41: expected a number";
  summary.log.companion_scans = 48;
  summary.log.spare_scans = 2;
  return summary;
}

TEST(SummaryJson, has_the_verdict_about_the_map) {
  const MappingResult result = walk_around_the_room();
  RunSummary summary = some_figures();
  EXPECT_TRUE(nlohmann::json::parse(summary_json(result, {}, summary))["verdict"].is_null());
  summary.verdict = doubtful_map();
  const auto verdict = nlohmann::json::parse(summary_json(result, {}, summary))["verdict"];
  EXPECT_EQ(verdict["state"], "check these places");
  EXPECT_EQ(
      verdict["sentence"],
      "check this place: doubled wall at (1.5, -0.5) m, error about 0.31 m; suspect: the loop of scan 45 "
      "with local map 3 at (2.0, 1.0) m");
  EXPECT_EQ(verdict["error_m"], 0.06);
  EXPECT_EQ(verdict["doubt_m"], 0.06);
  ASSERT_EQ(verdict["hot_spots"].size(), 1U);
  const auto& spot = verdict["hot_spots"][0];
  EXPECT_EQ(spot["kind"], "doubled wall");
  EXPECT_EQ(spot["x_m"], 1.5);
  EXPECT_EQ(spot["suspect"]["local_map"], 3);
  EXPECT_EQ(spot["advice"], "make the edit \"delete scan=45 local_map=3\"");
  EXPECT_EQ(spot["edit"], "delete scan=45 local_map=3");
  EXPECT_EQ(spot["suspect"]["places"], 1);
  EXPECT_EQ(verdict["more_hot_spots"], 0);
}

TEST(SummaryJson, lists_the_path_that_nothing_checks_and_that_scans_leave_open) {
  RunSummary summary;
  summary.verdict = MapVerdict();
  summary.verdict->held_share = 0.25;
  summary.verdict->unchecked_stretches = {{7, 90, 12.5, {1, 2}, {3, 4}, std::nullopt}};
  summary.verdict->open_stretches = {{20, 40, 6.5, {5, 6}, true}};
  const auto verdict = nlohmann::json::parse(summary_json({}, {}, summary))["verdict"];
  EXPECT_EQ(verdict["state"], "unchecked");
  EXPECT_EQ(verdict["held_share"], 0.25);
  EXPECT_EQ(verdict["unchecked_stretches"],
            nlohmann::json::parse(R"([{"first_scan": 7, "last_scan": 90, "length_m": 12.5, "first_x_m": 1.0,
              "first_y_m": 2.0, "last_x_m": 3.0, "last_y_m": 4.0, "sigma_m": null}])"));
  EXPECT_EQ(verdict["open_stretches"],
            nlohmann::json::parse(R"([{"first_scan": 20, "last_scan": 40, "length_m": 6.5, "x_m": 5.0,
              "y_m": 6.0, "has_odometry": true}])"));
}

TEST(SummaryJson, counts_the_hot_spots_that_it_leaves_out) {
  RunSummary summary = some_figures();
  summary.verdict = doubtful_map();
  summary.verdict->more_hot_spots = 7;
  summary.verdict->hot_spots[0].places_of_suspect = 8;
  summary.verdict->hot_spots[0].edit.reset();
  const auto verdict = nlohmann::json::parse(summary_json({}, {}, summary))["verdict"];
  EXPECT_EQ(verdict["more_hot_spots"], 7);
  EXPECT_EQ(verdict["hot_spots"][0]["suspect"]["places"], 8);
  EXPECT_TRUE(verdict["hot_spots"][0]["edit"].is_null());
}

TEST(SummaryJson, has_schema_and_figures) {
  const MappingResult result = walk_around_the_room();
  const RunInfo info{
      "0.1.0", "room \"1\".clf", {{"front_end.window_x_m", "0.3"}}, {"line 7 is not a message"}};
  const auto json = nlohmann::json::parse(summary_json(result, info, some_figures()));
  EXPECT_EQ(json["schema"], "psi-slam-summary");
  EXPECT_EQ(json["schema_version"], kSummarySchemaVersion);
  EXPECT_EQ(json["warnings"], nlohmann::json::array({"line 7 is not a message"}));
  EXPECT_EQ(json["program_version"], "0.1.0");
  EXPECT_EQ(json["log"]["name"], "room \"1\".clf");
  EXPECT_EQ(json["log"]["scans"], 50);
  EXPECT_EQ(json["log"]["first_time_s"], "976052905.167303");
  EXPECT_EQ(json["log"]["companion_scans"], 48);
  EXPECT_EQ(json["log"]["spare_scans"], 2);
  EXPECT_EQ(json["real_time_factor"], 19.6);
  EXPECT_EQ(json["last_pass_cut_short"], true);
  EXPECT_EQ(json["broken_off"], "room.clf:41: expected a number");
  EXPECT_EQ(json["settings"]["front_end.window_x_m"], "0.3");
  EXPECT_EQ(json["loop_counts"]["reasons"][0]["count"], 7);
  EXPECT_EQ(json["loop_counts"]["reasons"][0]["reason"], "the response is too low");
  ASSERT_EQ(json["loop_matchers"].size(), 1U);
  const auto& matcher = json["loop_matchers"][0];
  EXPECT_EQ(matcher["matcher"], "csm");
  EXPECT_EQ(matcher["attempts"], 12);
  EXPECT_EQ(matcher["found"], 2);
  EXPECT_EQ(matcher["accepted"], 1);
  EXPECT_EQ(matcher["evaluations"], 600);
  EXPECT_EQ(matcher["milliseconds"], 45.25);
  EXPECT_EQ(matcher["last_pass"]["attempts"], 2);
  EXPECT_EQ(matcher["last_pass"]["accepted"], 0);
  ASSERT_EQ(matcher["searches"].size(), 2U) << "only the searches that ran";
  EXPECT_EQ(matcher["searches"][0]["search"], "exhaustive");
  EXPECT_EQ(matcher["searches"][0]["attempts"], 9);
  EXPECT_EQ(matcher["searches"][0]["accepted"], 0);
  EXPECT_EQ(matcher["searches"][1]["search"], "branch_and_bound");
  EXPECT_EQ(matcher["searches"][1]["evaluations"], 400);
  EXPECT_EQ(matcher["searches"][1]["accepted"], 1);
  EXPECT_EQ(json["stages"][0]["calls"], 50);
}

TEST(SummaryJson, lists_the_stretches_of_unmatched_scans) {
  MappingResult result = walk_around_the_room();
  const auto summary_json_of = [&] {
    return nlohmann::json::parse(summary_json(result, {}, summary_of(result)))["unmatched_scans"];
  };
  EXPECT_EQ(summary_json_of(), nlohmann::json::parse(R"({"count": 0, "stretches": []})"));
  result.interruptions = {{3, 5}, {7, std::nullopt}};
  EXPECT_EQ(nlohmann::json::parse(summary_json(result, {}, summary_of(result)))["interruptions"],
            nlohmann::json::parse(
                R"([{"first_scan": 3, "found_scan": 5}, {"first_scan": 7, "found_scan": null}])"));
  result.frames[10].match = result.frames[11].match = result.frames[20].match = ScanMatch::kUnmatched;
  const auto unmatched = summary_json_of();
  EXPECT_EQ(unmatched["count"], 3);
  ASSERT_EQ(unmatched["stretches"].size(), 2U);
  const auto& stretch = unmatched["stretches"][0];
  EXPECT_EQ(stretch["first_scan"], 10);
  EXPECT_EQ(stretch["last_scan"], 11);
  EXPECT_EQ(stretch["first_time_s"], "976052907.167303");
  EXPECT_EQ(stretch["last_time_s"], "976052907.367303");
  EXPECT_NEAR(stretch["odometry_length_m"].get<double>(), 0.4, 0.1);
}

TEST(SummaryJson, counts_statements_from_outside_and_places_in_a_prior_map) {
  MappingResult result = walk_around_the_room();
  RunSummary summary = some_figures();
  const auto knowledge = [&] {
    return nlohmann::json::parse(summary_json(result, {}, summary))["knowledge"];
  };
  EXPECT_EQ(knowledge(), nlohmann::json::parse(R"({"used": 0, "left_out": 0, "prior_map": null})"));
  result.knowledge = {4, 1};
  summary.prior = PriorFit{false, 50, 18};
  EXPECT_EQ(knowledge(), nlohmann::json::parse(R"({"used": 4, "left_out": 1,
    "prior_map": {"accepted": false, "places": 50, "fitting_places": 18}})"));
}

TEST(SummaryJson, replaces_values_that_are_not_finite_or_not_utf8) {
  RunSummary summary = some_figures();
  summary.mean_response = std::numeric_limits<double>::quiet_NaN();
  const auto json = nlohmann::json::parse(summary_json({}, {"0.1.0", "caf\xe9.clf", {}}, summary));
  EXPECT_TRUE(json["mean_response"].is_null());
  EXPECT_TRUE(json["settings"].is_object());
  EXPECT_TRUE(nlohmann::json::parse(summary_json({}, {}, {}))["broken_off"].is_null());
}

}  // namespace
}  // namespace psi_slam
