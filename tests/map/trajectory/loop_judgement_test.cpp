// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/loop_judgement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "psi_slam/mapper.h"
#include "psi_slam/open_log.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr TimeUs kStart_us = 1'000'000'000;

TimeUs time_of(std::size_t frame) {
  return kStart_us + static_cast<TimeUs>(frame) * 1'000'000;
}

/// True pose of the robot: 20 m ahead in steps of half a metre, then back on a parallel path.
TPose2D truth(std::size_t frame) {
  const double along_m = 0.5 * static_cast<double>(frame);
  return frame <= 40 ? TPose2D(along_m, 0, 0) : TPose2D(40.5 - along_m, 0.4, M_PI);
}

/// A run along the true path. Each scan is a node; one local map has nodes 4 to 12. The front end turns 0.001
/// rad too far in each step.
MappingResult run() {
  MappingResult result;
  TPose2D front_end_T_robot;
  for (std::size_t i = 0; i <= 80; ++i) {
    if (i > 0) {
      TPose2D motion = truth(i) - truth(i - 1);
      motion.phi += 0.001;
      front_end_T_robot = front_end_T_robot + motion;
    }
    FrameRecord frame;
    frame.time_us = time_of(i);
    frame.front_end_T_robot = front_end_T_robot;
    frame.node = i;
    result.frames.push_back(frame);
    result.node_frames.push_back(i);
  }
  result.local_maps.push_back({4, 4, 12});
  return result;
}

void add_loop(MappingResult& result, std::size_t node, const TPose2D& moved = {}) {
  LoopRecord loop;
  loop.node = node;
  loop.anchor = result.local_maps.front().anchor;
  loop.anchor_T_node = truth(node) - truth(loop.anchor) + moved;
  loop.state = LoopState::kAccepted;
  result.loops.push_back(loop);
}

Relation relation(std::size_t frame1, std::size_t frame2) {
  return {time_of(frame1), time_of(frame2), truth(frame2) - truth(frame1)};
}

TEST(LoopJudgement, judges_a_true_loop_true) {
  MappingResult result = run();
  add_loop(result, 71);
  for (const auto& [first, second] : {std::pair(10, 72), std::pair(72, 10)}) {
    const LoopJudgement judgement =
        judge_loops(result, {relation(static_cast<std::size_t>(first), static_cast<std::size_t>(second))});
    ASSERT_EQ(judgement.judged.size(), 1U);
    EXPECT_FALSE(judgement.judged.front().is_false);
    EXPECT_LT(judgement.judged.front().error_m, 0.05);
    EXPECT_GT(judgement.judged.front().error_rad, 0.001) << "the front end's motion in between has errors";
    EXPECT_NEAR(judgement.judged.front().way_m, 0.5 + 3, 1e-6);
    EXPECT_EQ(judgement.precision(), 1);
    EXPECT_EQ(judgement.recall(), 1);
    EXPECT_TRUE(judgement.false_ones.empty());
  }
}

TEST(LoopJudgement, a_loop_is_false_beyond_the_limits_and_the_drift) {
  // The relation joins the anchor and the node of the loop, so the limits include no drift.
  const std::vector<Relation> relations{relation(4, 71)};
  const auto is_false = [&](const TPose2D& moved) {
    MappingResult result = run();
    add_loop(result, 71, moved);
    const LoopJudgement judgement = judge_loops(result, relations);
    EXPECT_EQ(judgement.judged.size(), 1U);
    EXPECT_EQ(judgement.false_ones.size(), judgement.precision() == 0 ? 1U : 0U);
    return judgement.judged.front().is_false;
  };
  EXPECT_FALSE(is_false({0.49, 0, 0}));
  EXPECT_TRUE(is_false({0, 0.51, 0}));
  EXPECT_FALSE(is_false({0, 0, radians_from_degrees(4.9L)}));
  EXPECT_TRUE(is_false({0, 0, -radians_from_degrees(5.1L)}));
}

TEST(LoopJudgement, allows_for_drift_along_the_path_in_between) {
  MappingResult result = run();
  add_loop(result, 71, {0.53, 0, 0});
  EXPECT_TRUE(judge_loops(result, {relation(4, 71)}).judged.front().is_false);
  LoopJudgementOptions generous;
  generous.drift_m_per_metre = 0.05;
  EXPECT_FALSE(judge_loops(result, {relation(12, 71)}, generous).judged.front().is_false);
  generous.drift_m_per_metre = 0;
  EXPECT_TRUE(judge_loops(result, {relation(12, 71)}, generous).judged.front().is_false);
}

TEST(LoopJudgement, uses_the_nearest_relation) {
  MappingResult result = run();
  add_loop(result, 71);
  Relation wrong = relation(12, 71);
  wrong.pose1_T_pose2.x += 3;
  const LoopJudgement judgement = judge_loops(result, {wrong, relation(5, 71)});
  ASSERT_EQ(judgement.judged.size(), 1U);
  EXPECT_EQ(judgement.judged.front().relation, 1U);
  EXPECT_FALSE(judgement.judged.front().is_false);
}

TEST(LoopJudgement, ignores_relations_elsewhere_on_the_path) {
  MappingResult result = run();
  add_loop(result, 71);
  // The relations end three nodes after the local map, three nodes after the loop's node, only within the
  // local map, and three nodes before the local map.
  const LoopJudgement judgement =
      judge_loops(result, {relation(15, 71), relation(8, 74), relation(4, 12), relation(1, 71)});
  EXPECT_TRUE(judgement.judged.empty());
  EXPECT_EQ(judgement.unjudged, 1U);
  EXPECT_FALSE(judgement.precision());
}

TEST(LoopJudgement, judges_accepted_loops_only) {
  MappingResult result = run();
  add_loop(result, 71, {5, 0, 0});
  for (const LoopState state : {LoopState::kRejected, LoopState::kCandidate}) {
    result.loops.front().state = state;
    const LoopJudgement judgement = judge_loops(result, {relation(10, 71)});
    EXPECT_EQ(judgement.judged.size() + judgement.unjudged, 0U);
    EXPECT_EQ(judgement.recall(), 0);
  }
}

TEST(LoopJudgement, recall_counts_relations_between_two_passes) {
  MappingResult result = run();
  add_loop(result, 71);
  // In this order: a relation that the loop joins, one with ends too near along the path, one with ends too
  // far apart, and one that no loop joins.
  const LoopJudgement judgement =
      judge_loops(result, {relation(10, 71), relation(10, 20), relation(0, 40), relation(30, 51)});
  EXPECT_EQ(judgement.passes, 2U);
  EXPECT_EQ(judgement.joined, 1U);
  EXPECT_DOUBLE_EQ(judgement.recall().value(), 0.5);
  EXPECT_FALSE(judge_loops(result, {relation(10, 20)}).recall());
}

TEST(LoopJudgement, interpolates_between_scans_and_ignores_unknown_times) {
  MappingResult result = run();
  add_loop(result, 71);
  Relation between = relation(10, 71);
  between.time1_us += 500'000;
  between.pose1_T_pose2 = truth(71) - TPose2D(5.25, 0, 0);
  Relation unknown = relation(10, 71);
  unknown.time2_us += 1'000'000'000;
  const LoopJudgement judgement = judge_loops(result, {unknown, between});
  ASSERT_EQ(judgement.judged.size(), 1U);
  EXPECT_EQ(judgement.judged.front().relation, 1U);
  EXPECT_LT(judgement.judged.front().error_m, 0.05);
  EXPECT_EQ(judgement.passes, 1U);
}

TEST(LoopJudgement, finds_a_moved_loop_of_a_real_log) {
  const auto log = shared_file("mit-csail.clf.gz");
  const auto truth_file = shared_file("mit-csail.relations");
  if (!log || !truth_file) GTEST_SKIP() << kNeedsData;
  const std::vector<Relation> relations = read_relations(*truth_file);
  LogOptions options;
  options.beam_angles = BeamAngles::kCentredStepInclusive;
  options.max_range_m = 50;
  const auto source = open_log(*log, options);
  Mapper mapper;
  while (auto frame = source->next()) mapper.add(std::move(*frame));
  MappingResult result = mapper.finish();
  const LoopJudgement before = judge_loops(result, relations);
  ASSERT_GT(before.judged.size(), 20U);
  EXPECT_GE(before.precision().value(), 0.97);
  EXPECT_GE(before.recall().value(), 0.5);

  const auto fits = [](const JudgedLoop& judged) { return judged.error_m < 0.2 && judged.error_rad < 0.03; };
  const auto chosen = std::find_if(before.judged.begin(), before.judged.end(), fits);
  ASSERT_NE(chosen, before.judged.end());
  result.loops[chosen->loop].anchor_T_node.x += 1.5;
  const LoopJudgement after = judge_loops(result, relations);
  ASSERT_EQ(after.false_ones.size(), before.false_ones.size() + 1);
  EXPECT_TRUE(std::any_of(after.false_ones.begin(), after.false_ones.end(),
                          [&](const JudgedLoop& judged) { return judged.loop == chosen->loop; }));
}

}  // namespace
}  // namespace psi_slam
