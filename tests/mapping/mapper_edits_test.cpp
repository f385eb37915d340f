// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "local_maps/simulated_drive.h"
#include "mapping/mapper_options.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/mapper.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using State = LoopEditOutcome::State;
using Kind = LoopEdit::Kind;

// One lap around the corridor of the office and again along its first side, with biased odometry.
const SimulatedDrive& round_drive() {
  static const SimulatedDrive drive = [] {
    OdometryErrors errors;
    errors.length_factor = 0.98;
    errors.turn_factor = 1.03;
    return drive_along(
        office_floor(),
        path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}, {16, 1.6}}, 0.16, 0.12),
        errors, 5);
  }();
  return drive;
}

std::string bytes_of(const MappingResult& result) {
  std::string bytes;
  for (const FrameRecord& frame : result.frames)
    for (const double value : {frame.map_T_robot.x, frame.map_T_robot.y, frame.map_T_robot.phi})
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  for (const LoopRecord& loop : result.loops)
    bytes += std::to_string(loop.frame) + ',' + std::to_string(loop.local_map) + ',' +
             std::to_string(static_cast<int>(loop.state)) + text_of(loop.rejection) + '\n';
  return bytes;
}

double error_m(const MappingResult& result) {
  double worst = 0;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const TPose2D off = result.frames[i].map_T_robot - round_drive().map_T_robot[i];
    worst = std::max(worst, std::hypot(off.x, off.y));
  }
  return worst;
}

class MapperEditsTest : public testing::Test {
 protected:
  void map_all() {
    for (const Frame& frame : round_drive().frames) mapper_.add(frame);
  }

  /// Returns the first match in a state.
  const LoopRecord& first(LoopState state) const {
    const auto& loops = mapper_.loops();
    const auto found = std::find_if(loops.begin(), loops.end(), [&](const LoopRecord& loop) {
      return loop.state == state && !found_nothing(loop);
    });
    if (found == loops.end()) throw std::logic_error("the drive has no such loop");
    return *found;
  }

  const LoopRecord& attempt(const LoopEdit& edit) const {
    const auto& loops = mapper_.loops();
    const auto found = std::find_if(loops.rbegin(), loops.rend(), [&](const LoopRecord& loop) {
      return loop.frame == edit.frame && loop.local_map == edit.local_map;
    });
    if (found == loops.rend()) throw std::logic_error("the two were never matched");
    return *found;
  }

  static LoopEdit edit_of(Kind kind, const LoopRecord& loop) { return {kind, loop.frame, loop.local_map}; }

  bool is_constraint(const LoopRecord& loop) const {
    const PoseGraph& graph = mapper_.graph();
    for (const std::uint32_t index : graph.constraints_of(loop.node)) {
      const Constraint& constraint = graph.constraint(index);
      if (graph.enabled(index) && constraint.kind == Constraint::Kind::kLoop &&
          constraint.from == loop.reference && constraint.to == loop.node &&
          constraint.from_T_to == loop.reference_T_node)
        return true;
    }
    return false;
  }

  Mapper mapper_;
};

TEST_F(MapperEditsTest, a_deleted_loop_stays_deleted_in_the_final_search) {
  map_all();
  const LoopRecord loop = first(LoopState::kAccepted);
  ASSERT_TRUE(is_constraint(loop));
  const LoopEdit edit = edit_of(Kind::kDelete, loop);
  EXPECT_EQ(mapper_.edit(edit).state, State::kDone);
  EXPECT_FALSE(is_constraint(loop));
  EXPECT_TRUE(rejected_by(attempt(edit), LoopRejection::Reason::kDeletedByHand));
  EXPECT_TRUE(attempt(edit).by_hand);
  const MappingResult result = mapper_.finish();
  for (const LoopRecord& end : result.loops) {
    if (end.frame != loop.frame || end.local_map != loop.local_map) continue;
    EXPECT_TRUE(rejected_by(end, LoopRejection::Reason::kDeletedByHand));
  }
}

TEST_F(MapperEditsTest, the_graph_is_optimised_at_once) {
  map_all();
  const std::vector<LoopRecord> loops = mapper_.loops();
  const TPose2D closed = mapper_.graph().poses().back();
  const auto for_accepted = [&](Kind kind) {
    for (const LoopRecord& loop : loops)
      if (loop.state == LoopState::kAccepted) mapper_.edit(edit_of(kind, loop));
    const TPose2D now = mapper_.graph().poses().back();
    return std::hypot(now.x - closed.x, now.y - closed.y);
  };
  EXPECT_GT(for_accepted(Kind::kDelete), 0.015) << "without loops, the map is distorted";
  const TPose2D robot = mapper_.map_T_robot();
  EXPECT_GT(std::hypot(robot.x - closed.x, robot.y - closed.y), 0.015)
      << "the pose of the robot changes with the map";
  EXPECT_LT(for_accepted(Kind::kRestore), 0.005) << "the restored loops correct the map again";
}

TEST_F(MapperEditsTest, a_loop_deleted_before_it_is_found_never_becomes_a_constraint) {
  map_all();
  const LoopRecord loop = first(LoopState::kAccepted);
  Mapper early;
  EXPECT_EQ(early.edit(edit_of(Kind::kDelete, loop)).state, State::kWaits);
  for (const Frame& frame : round_drive().frames) early.add(frame);
  const MappingResult result = early.finish();
  EXPECT_THAT(result.unmet_edits, IsEmpty());
  std::size_t attempts = 0;
  for (const LoopRecord& end : result.loops) {
    if (end.frame != loop.frame || end.local_map != loop.local_map) continue;
    ++attempts;
    EXPECT_TRUE(rejected_by(end, LoopRejection::Reason::kDeletedByHand));
  }
  EXPECT_EQ(attempts, 1U);
}

TEST_F(MapperEditsTest, a_rejected_loop_can_be_forced_and_nothing_rejects_it) {
  map_all();
  const LoopRecord loop = first(LoopState::kRejected);
  ASSERT_FALSE(is_constraint(loop));
  const LoopEdit edit = edit_of(Kind::kForce, loop);
  EXPECT_EQ(mapper_.edit(edit).state, State::kDone);
  EXPECT_TRUE(is_constraint(loop));
  EXPECT_EQ(attempt(edit).state, LoopState::kAccepted);
  const MappingResult result = mapper_.finish();
  const auto kept = std::count_if(result.loops.begin(), result.loops.end(), [&](const LoopRecord& end) {
    return end.frame == loop.frame && end.local_map == loop.local_map && end.state == LoopState::kAccepted &&
           end.by_hand;
  });
  EXPECT_EQ(kept, 1);
}

TEST_F(MapperEditsTest, a_loop_is_matched_again_by_any_matcher) {
  map_all();
  const LoopRecord loop =
      *std::max_element(mapper_.loops().begin(), mapper_.loops().end(),
                        [](const LoopRecord& a, const LoopRecord& b) { return a.response < b.response; });
  ASSERT_EQ(loop.state, LoopState::kAccepted);
  for (const MatcherKind matcher : {MatcherKind::kGa, MatcherKind::kCsmGa, MatcherKind::kCsm}) {
    LoopEdit edit = edit_of(Kind::kMatch, loop);
    edit.matcher = matcher;
    EXPECT_EQ(mapper_.edit(edit).state, State::kDone);
    const LoopRecord& again = attempt(edit);
    EXPECT_EQ(again.matcher, matcher);
    EXPECT_EQ(again.state, LoopState::kAccepted) << text_of(again.rejection);
    EXPECT_TRUE(is_constraint(again));
    EXPECT_NEAR(again.anchor_T_node.x, loop.anchor_T_node.x, 0.05);
    EXPECT_NEAR(again.anchor_T_node.y, loop.anchor_T_node.y, 0.05);
  }
}

TEST_F(MapperEditsTest, a_match_by_hand_searches_the_given_place) {
  map_all();
  const LoopRecord loop = first(LoopState::kAccepted);
  LoopEdit edit = edit_of(Kind::kMatch, loop);
  edit.place = LoopPlace{loop.anchor_T_node + TPose2D(0.8, -0.6, 0.2), {1.5, 1.5, 0.5}};
  ASSERT_EQ(mapper_.edit(edit).state, State::kDone);
  EXPECT_NEAR(attempt(edit).anchor_T_node.x, loop.anchor_T_node.x, 0.05);
  EXPECT_EQ(attempt(edit).state, LoopState::kAccepted) << "a match by hand needs no consensus";
  edit.place->anchor_T_node = loop.anchor_T_node + TPose2D(300, 0, 0);
  ASSERT_EQ(mapper_.edit(edit).state, State::kDone);
  EXPECT_TRUE(found_nothing(attempt(edit)));
  EXPECT_FALSE(is_constraint(loop)) << "the earlier match no longer counts";
}

TEST_F(MapperEditsTest, a_restored_loop_is_as_the_mapper_found_it) {
  map_all();
  for (const LoopState state : {LoopState::kAccepted, LoopState::kRejected}) {
    const LoopRecord loop = first(state);
    for (const Kind kind : {Kind::kDelete, Kind::kForce, Kind::kMatch}) {
      mapper_.edit(edit_of(kind, loop));
      EXPECT_EQ(mapper_.edit(edit_of(Kind::kRestore, loop)).state, State::kDone);
      const LoopRecord& again = attempt(edit_of(kind, loop));
      EXPECT_EQ(again.state, state);
      EXPECT_EQ(again.anchor_T_node, loop.anchor_T_node);
      EXPECT_EQ(again.matcher, loop.matcher);
      EXPECT_FALSE(again.by_hand);
      EXPECT_EQ(is_constraint(again), state == LoopState::kAccepted);
    }
    EXPECT_EQ(mapper_.edit(edit_of(Kind::kRestore, loop)).state, State::kImpossible);
  }
}

TEST_F(MapperEditsTest, an_impossible_edit_changes_no_pose) {
  MapperOptions options;
  options.latency_nodes = 100'000;
  Mapper mapper(options);
  for (const Frame& frame : round_drive().frames) mapper.add(frame);
  const std::vector<TPose2D> before = mapper.node_poses();
  ASSERT_NE(before, mapper.graph().poses()) << "no correction waits, so nothing is tested";
  const std::size_t last = mapper.frames().size() - 1;
  const std::size_t node_frame = mapper.frames()[last].node ? last : mapper.keyframes().nodes.back().frame;
  EXPECT_EQ(mapper.edit({Kind::kRestore, node_frame, 0}).state, State::kImpossible);
  EXPECT_EQ(mapper.node_poses(), before);
}

TEST_F(MapperEditsTest, explains_impossible_edits) {
  map_all();
  mapper_.end_log();
  std::size_t between = 1;
  while (mapper_.frames()[between].node) ++between;
  const LoopEditOutcome no_node = mapper_.edit({Kind::kDelete, between, 0});
  EXPECT_EQ(no_node.state, State::kImpossible);
  EXPECT_THAT(no_node.reason, HasSubstr("is not a node of the graph"));
  const LoopEditOutcome itself = mapper_.edit({Kind::kForce, 0, 0});
  EXPECT_EQ(itself.state, State::kImpossible);
  EXPECT_THAT(itself.reason, HasSubstr("scan 0 is part of local map 0"));
  EXPECT_EQ(mapper_.edit({Kind::kDelete, 0, 999}).state, State::kWaits);
  EXPECT_THAT(mapper_.finish().unmet_edits,
              ElementsAre("delete the loop of scan 0 with local map 999: local map 999 is not finished"));
}

TEST_F(MapperEditsTest, without_loop_closing_every_edit_is_impossible) {
  MapperOptions options;
  options.close_loops = false;
  Mapper mapper(options);
  EXPECT_EQ(mapper.edit({Kind::kDelete, 0, 1}).state, State::kImpossible);
}

TEST_F(MapperEditsTest, reopening_and_finishing_gives_the_same_map) {
  map_all();
  MappingResult result = mapper_.finish({}, Mapper::AfterFinish::kReopen);
  const std::string first_time = bytes_of(result);
  EXPECT_LT(error_m(result), 0.2);
  mapper_.reopen(std::move(result));
  EXPECT_EQ(bytes_of(mapper_.finish({}, Mapper::AfterFinish::kReopen)), first_time);
}

TEST_F(MapperEditsTest, an_edit_after_reopening_gives_the_same_map_as_before_finishing) {
  map_all();
  Mapper straight;
  for (const Frame& frame : round_drive().frames) straight.add(frame);
  MappingResult result = mapper_.finish({}, Mapper::AfterFinish::kReopen);
  const auto in_final_search = std::find_if(
      result.loops.begin(), result.loops.end(),
      [](const LoopRecord& loop) { return loop.in_final_search && loop.state == LoopState::kAccepted; });
  ASSERT_NE(in_final_search, result.loops.end());
  const LoopEdit edit = edit_of(Kind::kDelete, *in_final_search);
  mapper_.reopen(std::move(result));
  straight.end_log();
  EXPECT_EQ(mapper_.edit(edit).state, State::kDone);
  EXPECT_EQ(straight.edit(edit).state, State::kDone);
  const MappingResult edited = mapper_.finish({}, Mapper::AfterFinish::kReopen);
  EXPECT_EQ(bytes_of(edited), bytes_of(straight.finish()));
  const auto deleted = std::find_if(edited.loops.begin(), edited.loops.end(), [&](const LoopRecord& loop) {
    return loop.frame == edit.frame && loop.local_map == edit.local_map;
  });
  ASSERT_NE(deleted, edited.loops.end()) << "a deleted loop stays in the list, so it can be restored";
  EXPECT_TRUE(rejected_by(*deleted, LoopRejection::Reason::kDeletedByHand));
}

TEST_F(MapperEditsTest, forcing_a_loop_of_the_final_search_takes_its_match) {
  map_all();
  MappingResult result = mapper_.finish({}, Mapper::AfterFinish::kReopen);
  // Searches for a pair that was rejected while mapping and accepted by the final search. The edit must force
  // the second match.
  std::optional<LoopRecord> chosen;
  for (const LoopRecord& loop : result.loops) {
    if (!loop.in_final_search || loop.state != LoopState::kAccepted) continue;
    if (!chosen) chosen = loop;
    for (const LoopRecord& other : result.loops)
      if (!other.in_final_search && other.state == LoopState::kRejected && !found_nothing(other) &&
          other.node == loop.node && other.local_map == loop.local_map)
        chosen = loop;
  }
  ASSERT_TRUE(chosen.has_value());
  LoopEdit edit = edit_of(Kind::kForce, *chosen);
  edit.of_final_search = true;
  EXPECT_EQ(mapper_.judge(edit, result.frames).state, State::kDone);
  mapper_.reopen(std::move(result));
  EXPECT_EQ(mapper_.edit(edit).state, State::kWaits);
  const MappingResult forced = mapper_.finish();
  EXPECT_THAT(forced.unmet_edits, IsEmpty());
  const auto found = std::find_if(forced.loops.rbegin(), forced.loops.rend(), [&](const LoopRecord& loop) {
    return loop.frame == edit.frame && loop.local_map == edit.local_map;
  });
  ASSERT_NE(found, forced.loops.rend());
  EXPECT_TRUE(found->in_final_search);
  EXPECT_TRUE(found->by_hand);
  EXPECT_EQ(found->state, LoopState::kAccepted);
  EXPECT_NEAR(found->anchor_T_node.x, chosen->anchor_T_node.x, 0.05);
  EXPECT_NEAR(found->anchor_T_node.y, chosen->anchor_T_node.y, 0.05);
}

TEST_F(MapperEditsTest, the_final_search_may_find_a_loop_that_was_added_and_restored) {
  map_all();
  MappingResult result = mapper_.finish({}, Mapper::AfterFinish::kReopen);
  const auto only_final_search = [&](const LoopRecord& loop) {
    return loop.in_final_search && loop.state == LoopState::kAccepted &&
           std::count_if(result.loops.begin(), result.loops.end(), [&](const LoopRecord& other) {
             return other.node == loop.node && other.local_map == loop.local_map;
           }) == 1;
  };
  const auto found = std::find_if(result.loops.begin(), result.loops.end(), only_final_search);
  ASSERT_NE(found, result.loops.end());
  const LoopRecord loop = *found;
  mapper_.reopen(std::move(result));
  LoopEdit edit = edit_of(Kind::kMatch, loop);
  edit.place = LoopPlace{loop.anchor_T_predicted, loop.window};
  EXPECT_EQ(mapper_.edit(edit).state, State::kDone);
  EXPECT_EQ(mapper_.edit(edit_of(Kind::kRestore, loop)).state, State::kDone);
  EXPECT_EQ(mapper_.edit(edit_of(Kind::kRestore, loop)).state, State::kImpossible);
  const MappingResult again = mapper_.finish();
  EXPECT_TRUE(std::any_of(again.loops.begin(), again.loops.end(), [&](const LoopRecord& now) {
    return now.node == loop.node && now.local_map == loop.local_map && now.in_final_search &&
           now.state == LoopState::kAccepted && !now.by_hand;
  }));
}

}  // namespace
}  // namespace psi_slam
