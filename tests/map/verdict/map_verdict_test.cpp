// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/map_verdict.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "two_passes.h"

namespace psi_slam {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Options for which both rounds are a single pass, and each scan is a view.
VerdictOptions options_of_single_pass() {
  VerdictOptions options;
  options.passes.pass_apart_m = 100;
  options.views.step_m = 0.1;
  return options;
}

void shorten_ranges(Frame& frame) {
  for (float& range_m : frame.scan.ranges_m) range_m *= 0.6F;
}

std::vector<HotSpot> spots_of(const MapVerdict& verdict, HotSpot::Kind kind) {
  std::vector<HotSpot> spots;
  for (const HotSpot& spot : verdict.hot_spots)
    if (spot.kind == kind) spots.push_back(spot);
  return spots;
}

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
  EXPECT_NEAR(worst.error_m.value_or(0), 0.3, 0.1);
  const double to_wall_m = std::min({std::abs(worst.at.x - -2), std::abs(worst.at.x - 4)});
  EXPECT_LT(to_wall_m, 0.5) << "at the walls that are displaced along their normals";
  EXPECT_THAT(hot_spot_text(worst), HasSubstr("doubled wall at ("));
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
    EXPECT_FALSE(spot.edit) << "the graph has no such constraint, so nothing would move";
    EXPECT_EQ(advice_text(spot), "look at this loop in psi-slam-gui") << "no edit was tried";
    EXPECT_THAT(text_of(spot.suspect), HasSubstr("the loop of scan 50 with local map 0 at ("));
  }
}

TEST(MapVerdict, blames_a_loop_only_for_the_path_that_it_bends) {
  MappingResult result = two_passes({0.3, 0, 0});
  result.loops = {loop_between(result, 0, 2, {2, 0, 0})};
  const MapVerdict verdict = judge_map(result);
  const std::vector<HotSpot> conflicts = spots_of(verdict, HotSpot::Kind::kLoopConflict);
  ASSERT_EQ(conflicts.size(), 1U);
  EXPECT_EQ(conflicts.front().suspect.kind, Suspect::Kind::kLoop);
  const std::vector<HotSpot> walls = spots_of(verdict, HotSpot::Kind::kDoubledWall);
  ASSERT_FALSE(walls.empty());
  for (const HotSpot& wall : walls) EXPECT_EQ(wall.suspect.kind, Suspect::Kind::kStretch);
}

TEST(MapVerdict, finds_a_conflict_behind_a_loop_that_is_only_turned) {
  MappingResult result = two_passes();
  result.loops = {loop_between(result, 2, 42, {0, 0, 1}), loop_between(result, 10, 50, {0.4, 0, 0})};
  const std::vector<HotSpot> conflicts = spots_of(judge_map(result), HotSpot::Kind::kLoopConflict);
  ASSERT_EQ(conflicts.size(), 1U);
  EXPECT_EQ(conflicts.front().suspect.loop, 1U);
}

/// Displaces a scan and all later ones in the map.
void displace_from(std::size_t frame, MappingResult& result) {
  for (std::size_t i = frame; i < result.frames.size(); ++i) result.frames[i].map_T_robot.x += 0.45;
}

TEST(MapVerdict, asks_to_check_a_single_pass_with_a_jump) {
  MappingResult result = two_passes();
  displace_from(30, result);
  const MapVerdict verdict = judge_map(result, options_of_single_pass());
  EXPECT_EQ(verdict.state, MapState::kCheck);
  EXPECT_GT(verdict.error_m, 0.01);
  const std::vector<HotSpot> misfits = spots_of(verdict, HotSpot::Kind::kMisfit);
  ASSERT_EQ(misfits.size(), 1U);
  EXPECT_LE(misfits.front().suspect.first_frame, 34U);
  EXPECT_GE(misfits.front().suspect.last_frame, 27U);
  EXPECT_LT(misfits.front().length_m, 1);
}

TEST(MapVerdict, asks_for_no_check_of_scans_that_no_motion_explains) {
  MappingResult result = two_passes();
  for (const std::size_t frame : {20U, 30U, 31U}) shorten_ranges(result.log[frame]);
  EXPECT_EQ(judge_map(result, options_of_single_pass()).state, MapState::kUnchecked);
}

TEST(MapVerdict, asks_to_check_a_short_stretch_without_a_match) {
  MappingResult result = two_passes();
  for (std::size_t i = 38; i < 42; ++i) result.frames[i].match = ScanMatch::kUnmatched;
  const MapVerdict verdict = judge_map(result, options_of_single_pass());
  EXPECT_EQ(verdict.state, MapState::kCheck);
  ASSERT_EQ(verdict.hot_spots.size(), 1U);
  EXPECT_EQ(verdict.hot_spots.front().kind, HotSpot::Kind::kUnmatched);
  EXPECT_NEAR(verdict.error_m, 0.5 * verdict.hot_spots.front().error_m.value_or(0), 0.02);
}

TEST(MapVerdict, measures_the_error_before_it_shortens_the_list) {
  MappingResult result = two_passes();
  displace_from(30, result);
  displace_from(50, result);
  VerdictOptions options = options_of_single_pass();
  const MapVerdict whole = judge_map(result, options);
  options.most_hot_spots = 1;
  const MapVerdict shortened = judge_map(result, options);
  EXPECT_EQ(shortened.hot_spots.size(), 1U);
  EXPECT_EQ(shortened.more_hot_spots, 1U);
  EXPECT_EQ(shortened.error_m, whole.error_m);
  EXPECT_EQ(shortened.state, whole.state);
  EXPECT_THAT(verdict_sentence(shortened), HasSubstr("check 2 places of the map"));
}

/// Adds constraints between successive nodes. The one to `weak` has a standard deviation of weak_sigma_m, or
/// is a provisional start if it is so weak.
void join_nodes(MappingResult& result, std::size_t weak, double weak_sigma_m) {
  for (std::size_t node = 1; node < result.node_frames.size(); ++node) {
    Constraint step;
    step.from = node - 1;
    step.to = node;
    step.from_T_to = result.graph.pose(node) - result.graph.pose(node - 1);
    step.information = Eigen::Matrix3d::Identity() * 1e6;
    if (node == weak) {
      step.kind = Constraint::Kind::kRunStart;
      step.information = Eigen::Matrix3d::Identity() / (weak_sigma_m * weak_sigma_m);
    }
    result.graph.add_constraint(step);
  }
}

/// Map of two rounds, the second of which is displaced after an uncertain step, with two local maps for each
/// round.
MappingResult displaced_round() {
  MappingResult result = two_passes({0.3, 0, 0});
  join_nodes(result, kScansPerRound, 0.2);
  const std::size_t half = kScansPerRound / 2;
  result.local_maps.clear();
  for (std::size_t first = 0; first < result.node_frames.size(); first += half)
    result.local_maps.push_back({first, first, first + half - 1});
  result.frames.back().searched_loops = true;
  return result;
}

TEST(MapVerdict, advises_loop_closing_where_it_was_off) {
  MappingResult result = displaced_round();
  result.frames.back().searched_loops = false;
  const auto expect_no_edit = [&] {
    const MapVerdict verdict = judge_map(result);
    ASSERT_FALSE(verdict.hot_spots.empty());
    EXPECT_FALSE(verdict.hot_spots.front().edit) << "it would have no effect";
    EXPECT_THAT(advice_text(verdict.hot_spots.front()), EndsWith("set loop_closure.enabled=true"));
  };
  expect_no_edit();
  for (std::size_t i = kScansPerRound - 3; i < kScansPerRound; ++i)
    result.frames[i].match = ScanMatch::kUnmatched;
  expect_no_edit();
  for (std::size_t i = kScansPerRound; i < result.frames.size(); ++i) {
    result.frames[i].match = ScanMatch::kMatched;
    result.frames[i].time_us += 60'000'000;
  }
  expect_no_edit();
  result.interruptions = {{kScansPerRound, kScansPerRound + 2}};
  expect_no_edit();
  result.interruptions = {{kScansPerRound, std::nullopt}};
  expect_no_edit();
}

TEST(MapVerdict, advises_to_match_a_scan_with_a_local_map_before_the_suspect) {
  const MappingResult result = displaced_round();
  const MapVerdict verdict = judge_map(result);
  ASSERT_FALSE(verdict.hot_spots.empty());
  const HotSpot& worst = verdict.hot_spots.front();
  ASSERT_TRUE(worst.edit);
  EXPECT_EQ(worst.edit->kind, LoopEdit::Kind::kMatch);
  EXPECT_GE(worst.edit->frame, worst.suspect.last_frame);
  ASSERT_LT(worst.edit->local_map, 2U) << "of the first round";
  EXPECT_THAT(advice_text(worst),
              StartsWith("make the edit \"match scan=" + std::to_string(worst.edit->frame) + " local_map=" +
                         std::to_string(worst.edit->local_map) + " matcher=csm\" of the scan at ("));
  ASSERT_TRUE(worst.effect);
  EXPECT_NEAR(worst.effect->moved_m, 0.3, 0.05);
}

TEST(MapVerdict, advises_to_force_a_match_by_hand_that_is_an_outlier) {
  MappingResult result = displaced_round();
  LoopRecord loop = loop_between(result, 10, 50);
  loop.reference_T_node = (mrpt::math::TPose2D(-0.3, 0, 0) + result.graph.pose(50)) - result.graph.pose(10);
  const std::size_t constraint = result.graph.add_constraint({10,
                                                              50,
                                                              loop.reference_T_node,
                                                              Eigen::Matrix3d::Identity() * 1e4,
                                                              Eigen::Matrix3d::Zero(),
                                                              Constraint::Kind::kLoop,
                                                              {}});
  result.graph.set_enabled(constraint, false);
  reject(loop, {LoopRejection::Reason::kContradicted});
  result.loops = {loop};
  const auto line = [&] { return edit_line(judge_map(result).hot_spots.at(0)); };
  EXPECT_THAT(line(), HasSubstr("match ")) << "it was not made by hand";
  result.loops[0].by_hand = true;
  EXPECT_EQ(line(), "force scan=50 local_map=0 after=end");
}

TEST(MapVerdict, advises_no_edit_that_was_made) {
  MappingResult result = displaced_round();
  const LoopEdit advised = judge_map(result).hot_spots.at(0).edit.value();
  LoopRecord made = loop_between(result, 10, advised.frame);
  made.local_map = advised.local_map;
  reject(made, {LoopRejection::Reason::kLowResponse});
  made.by_hand = true;
  result.loops = {made};
  for (const HotSpot& spot : judge_map(result).hot_spots)
    EXPECT_FALSE(spot.edit && same_loop(*spot.edit, advised)) << edit_line(spot);
}

TEST(MapVerdict, advises_no_edit_that_moves_nothing) {
  MappingResult result = displaced_round();
  Constraint step;
  step.kind = Constraint::Kind::kLocalMap;
  step.information = Eigen::Matrix3d::Identity() * 1e9;  // so sure that no loop bends it
  for (step.to = 1; step.to < result.node_frames.size(); ++step.to) {
    step.from = step.to - 1;
    step.from_T_to = result.graph.pose(step.to) - result.graph.pose(step.from);
    result.graph.add_constraint(step);
  }
  const MapVerdict verdict = judge_map(result);
  ASSERT_FALSE(verdict.hot_spots.empty());
  for (const HotSpot& spot : verdict.hot_spots) EXPECT_FALSE(spot.edit) << edit_line(spot);
  EXPECT_THAT(advice_text(verdict.hot_spots.front()), HasSubstr("no edit of one loop was found"));
}

TEST(MapVerdict, calls_only_the_largest_error_the_worst) {
  MappingResult result = two_passes({0.3, 0, 0});
  join_nodes(result, kScansPerRound, 3);  // predicts metres where the scans show 0.3 m
  const MapVerdict verdict = judge_map(result);
  ASSERT_GE(verdict.hot_spots.size(), 2U);
  double largest_m = 0;
  for (const HotSpot& spot : verdict.hot_spots) {
    if (is_predicted(spot.kind)) continue;
    EXPECT_LE(spot.error_m.value(), verdict.hot_spots.front().error_m.value()) << hot_spot_text(spot);
    largest_m = std::max(largest_m, spot.error_m.value());
  }
  EXPECT_LT(largest_m, 1);
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("the worst that scans show: "));
}

TEST(MapVerdict, compares_the_worst_with_places_beyond_the_list) {
  MappingResult result = two_passes({0.3, 0, 0});
  join_nodes(result, kScansPerRound, 3);
  VerdictOptions options;
  options.most_hot_spots = 1;
  const MapVerdict verdict = judge_map(result, options);
  ASSERT_EQ(verdict.hot_spots.size(), 1U);
  EXPECT_GT(verdict.largest_error_m, *verdict.hot_spots.front().error_m);
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("the worst that scans show: "));
}

TEST(MapVerdict, states_times_since_the_start_of_each_run) {
  MappingResult result = two_passes({0, 0.3, 0});
  result.later_run_frames = {kScansPerRound};
  for (std::size_t i = kScansPerRound; i < result.frames.size(); ++i)
    result.frames[i].time_us -= 3'600'000'000;  // recorded before the other run
  const MapVerdict verdict = judge_map(result);
  ASSERT_FALSE(verdict.hot_spots.empty());
  for (const HotSpot& spot : verdict.hot_spots) {
    EXPECT_GE(spot.suspect.first_s.value_or(0), 0);
    EXPECT_GE(spot.suspect.last_s.value(), 0);
    EXPECT_LE(spot.suspect.last_s.value(), 0.2 * kScansPerRound);
  }
}

TEST(MapVerdict, advises_no_match_where_no_local_map_ends_before_the_suspect) {
  MappingResult result = two_passes({0.3, 0, 0});
  result.frames.back().searched_loops = true;
  const MapVerdict verdict = judge_map(result);
  ASSERT_FALSE(verdict.hot_spots.empty());
  EXPECT_EQ(edit_line(verdict.hot_spots.front()), "");
  EXPECT_THAT(advice_text(verdict.hot_spots.front()), Not(HasSubstr("match")));
}

TEST(MapVerdict, counts_the_places_of_a_suspect_also_beyond_the_list) {
  MappingResult result = two_passes({0.3, 0, 0});
  result.loops = {loop_between(result, 10, 50, {2, 0, 0})};
  VerdictOptions options;
  const MapVerdict whole = judge_map(result, options);
  ASSERT_GE(whole.hot_spots.size(), 2U);
  options.most_hot_spots = 1;
  const HotSpot worst = judge_map(result, options).hot_spots.at(0);
  EXPECT_EQ(worst.places_of_suspect, whole.hot_spots.size()) << "the loop is the only suspect";
  EXPECT_THAT(hot_spot_text(worst), HasSubstr("; suspect of " + std::to_string(whole.hot_spots.size()) +
                                              " places: the loop of scan 50"));
}

TEST(MapVerdict, states_an_error_that_is_too_large_to_measure_as_a_bound) {
  HotSpot spot;
  spot.error_m = 0.994;
  EXPECT_EQ(error_text(spot), "0.99 m");
  EXPECT_THAT(hot_spot_text(spot), HasSubstr("error about 0.99 m;"));
  spot.error_m = 1;
  EXPECT_THAT(hot_spot_text(spot), HasSubstr("error of 1 m or more;"));
  spot.kind = HotSpot::Kind::kUncertain;
  spot.error_m = 2.5;
  EXPECT_THAT(hot_spot_text(spot), HasSubstr("error about 2.50 m;"));
  spot.error_m.reset();
  EXPECT_EQ(error_text(spot), "");
}

TEST(MapVerdict, confirms_unmatched_scans_only_if_other_scans_fit_across_them) {
  MappingResult result = two_passes();
  result.frames[20].match = ScanMatch::kUnmatched;
  result.frames.back().match = ScanMatch::kUnmatched;
  const MapVerdict verdict = judge_map(result);
  EXPECT_EQ(verdict.state, MapState::kGood);
  ASSERT_EQ(verdict.confirmed_stretches.size(), 1U) << "no scan follows the last one";
  EXPECT_EQ(verdict.confirmed_stretches[0].begin, 20U);
  EXPECT_EQ(verdict.confirmed_stretches[0].end, 21U);
}

TEST(MapVerdict, confirms_no_unmatched_scans_that_are_a_suspect) {
  MappingResult result = two_passes({0.3, 0, 0});
  result.frames[kScansPerRound - 1].match = ScanMatch::kUnmatched;
  EXPECT_TRUE(judge_map(result).confirmed_stretches.empty());
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
  EXPECT_FALSE(verdict.hot_spots.front().error_m);
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("the map is broken: a run was never placed"));
  EXPECT_THAT(verdict_sentence(verdict), Not(HasSubstr("mean error")));
}

TEST(MapVerdict, predicts_no_error_for_a_run_beside_the_map) {
  MappingResult result = two_passes({30, 0, 0});
  join_nodes(result, kScansPerRound, 900);
  EXPECT_GT(judge_map(result).predicted_m, 100);
  result = two_passes({30, 0, 0});
  join_nodes(result, kScansPerRound, 1e3);
  EXPECT_LT(judge_map(result).predicted_m, 0.1);
}

TEST(MapVerdict, asks_to_check_a_map_whose_graph_predicts_a_large_error) {
  MappingResult result = two_passes();
  join_nodes(result, kScansPerRound, 1);
  const MapVerdict verdict = judge_map(result);
  EXPECT_EQ(verdict.state, MapState::kCheck);
  const std::vector<HotSpot> spots = spots_of(verdict, HotSpot::Kind::kUncertain);
  ASSERT_FALSE(spots.empty());
  EXPECT_EQ(spots.front().suspect.kind, Suspect::Kind::kDrift);
  EXPECT_THAT(hot_spot_text(spots.front()), HasSubstr("uncertain place at ("));
  EXPECT_THAT(advice_text(spots.front()), HasSubstr("loop_closure"));
  EXPECT_LT(verdict.error_m, 0.02) << "the scans show no error";
}

TEST(MapVerdict, names_the_gap_after_which_the_robot_was_elsewhere) {
  MappingResult result = two_passes({0.6, 0.4, 0});
  for (std::size_t i = kScansPerRound; i < result.frames.size(); ++i) result.frames[i].time_us += 60'000'000;
  const MapVerdict verdict = judge_map(result);
  EXPECT_EQ(verdict.state, MapState::kBroken);
  ASSERT_EQ(spots_of(verdict, HotSpot::Kind::kGapDisagrees).size(), 1U);
  for (const HotSpot& spot : verdict.hot_spots) {
    EXPECT_EQ(spot.suspect.kind, Suspect::Kind::kGap) << hot_spot_text(spot);
    EXPECT_EQ(spot.suspect.first_frame, static_cast<std::size_t>(kScansPerRound));
  }
}

TEST(MapVerdict, suspects_an_interruption_where_the_passes_part) {
  MappingResult result = two_passes({0.3, 0, 0});
  result.interruptions = {{kScansPerRound, kScansPerRound + 2}};
  VerdictOptions options;
  options.contradiction = 1;  // leaves the suspect to the displaced walls
  const MapVerdict verdict = judge_map(result, options);
  ASSERT_FALSE(verdict.hot_spots.empty());
  EXPECT_EQ(verdict.hot_spots.front().suspect.kind, Suspect::Kind::kLost);
}

TEST(MapVerdict, says_that_nothing_was_checked) {
  const MapVerdict verdict = judge_map(MappingResult{});
  EXPECT_EQ(verdict.state, MapState::kUnchecked);
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("the map is unchecked: no place was seen twice"));
  EXPECT_THAT(verdict_sentence(verdict), EndsWith("return to places seen before"));
}

TEST(MapVerdict, names_the_path_to_drive_again_if_no_place_was_seen_twice) {
  MappingResult result = two_passes();
  join_nodes(result, 0, 1);
  const MapVerdict verdict = judge_map(result, options_of_single_pass());
  EXPECT_EQ(verdict.state, MapState::kUnchecked);
  EXPECT_EQ(verdict.held_share, 0);
  ASSERT_EQ(verdict.unchecked_stretches.size(), 1U);
  EXPECT_THAT(verdict_sentence(verdict),
              HasSubstr("; drive again from (3.0, 1.0) m to (3.0, 0.8) m, scans 0 to 79, "
                        "where the standard deviation of the position reaches 0.0"));
}

TEST(MapVerdict, leaves_a_map_unchecked_most_of_which_was_seen_once) {
  // After both rounds, the robot drives on along a path of its own.
  MappingResult result = two_passes();
  const std::size_t scans = result.frames.size();
  for (std::size_t i = 0; i < 3 * scans; ++i) {
    const std::size_t index = result.frames.size();
    Frame frame = result.log[i % scans];
    frame.index = index;
    FrameRecord record = result.frames[i % scans];
    record.map_T_robot.x += 20 + 5 * static_cast<double>(i);
    record.time_us = frame.time_us = 200'000 * static_cast<TimeUs>(index);
    record.node = result.graph.add_node(record.map_T_robot);
    result.node_frames.push_back(index);
    result.frames.push_back(record);
    result.log.push_back(std::move(frame));
  }
  const MapVerdict verdict = judge_map(result);
  EXPECT_EQ(verdict.state, MapState::kUnchecked) << verdict_sentence(verdict);
  EXPECT_GT(verdict.checked_share, 0.1);
  EXPECT_LT(verdict.held_share, 0.5);
  EXPECT_THAT(verdict_sentence(verdict),
              HasSubstr(" % of the path lies between places that were seen twice; drive "));
}

TEST(MapVerdict, calls_no_map_good_whose_walls_differ) {
  const MapVerdict verdict = judge_map(two_passes({0, 0.115, 0}));
  EXPECT_GT(verdict.wall_thickness_m, 0.1);
  EXPECT_EQ(verdict.state, MapState::kCheck);
  ASSERT_EQ(verdict.hot_spots.size(), 1U);
  EXPECT_NEAR(verdict.hot_spots[0].error_m.value_or(0), 0.12, 0.03);
  EXPECT_THAT(verdict_sentence(verdict),
              HasSubstr("the map is not good: walls of different passes differ by 0.1"));
}

/// Lengthens the room of two passes to a corridor along x, whose ends are out of sight.
MappingResult bare_corridor(bool has_odometry) {
  MappingResult result = two_passes();
  SimulatedRoom corridor;
  corridor.x_min = -100;
  corridor.x_max = 100;
  for (std::size_t i = 0; i < result.log.size(); ++i) {
    Frame& frame = result.log[i];
    frame.scan.ranges_m =
        corridor.scan_from(result.frames[i].map_T_robot, frame.scan.bearings_rad).scan.ranges_m;
    for (float& range_m : frame.scan.ranges_m)
      if (range_m > 15) range_m = std::numeric_limits<float>::infinity();
    frame.has_odometry = has_odometry;
  }
  return result;
}

TEST(MapVerdict, calls_no_map_good_whose_length_nothing_measures) {
  const MapVerdict verdict = judge_map(bare_corridor(false));
  EXPECT_EQ(verdict.state, MapState::kCheck);
  ASSERT_EQ(verdict.hot_spots.size(), 1U);
  const HotSpot& spot = verdict.hot_spots[0];
  EXPECT_EQ(spot.kind, HotSpot::Kind::kOpenDirection);
  EXPECT_NEAR(spot.length_m, 16, 2) << "twice there and back over 4 m";
  EXPECT_NEAR(spot.error_m.value_or(0), 0.1 * spot.length_m, 1e-9);
  EXPECT_THAT(hot_spot_text(spot), HasSubstr("open direction at ("));
  EXPECT_THAT(advice_text(spot), HasSubstr("record odometry"));
  EXPECT_THAT(verdict_sentence(verdict),
              HasSubstr("along bare walls, the constant-velocity model alone gives the length of 1"));
}

TEST(MapVerdict, counts_the_path_whose_length_odometry_alone_gives) {
  const MapVerdict verdict = judge_map(bare_corridor(true));
  EXPECT_EQ(verdict.state, MapState::kGood);
  EXPECT_EQ(verdict.open_stretches.size(), 1U);
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("the map is good"));
  EXPECT_THAT(verdict_sentence(verdict), HasSubstr("along bare walls, odometry alone gives the length of 1"));
}

}  // namespace
}  // namespace psi_slam
