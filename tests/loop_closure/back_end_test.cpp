// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/back_end.h"

#include <gtest/gtest.h>

#include <cmath>

#include "two_rounds.h"

namespace psi_slam {
namespace {

BackEndOptions near_maps_too() {
  BackEndOptions options;
  options.loop_closure.candidates.min_travel_m = 3;
  options.loop_closure.attempt_distance_m = 0.3;
  return options;
}

/// Closes the loops of all nodes, as they would come.
std::size_t close_all(BackEnd& back_end, PoseGraph& graph) {
  const TwoRounds& rounds = two_rounds();
  std::size_t made = 0;
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) {
    back_end.move(0.15, {graph.pose(node).x, graph.pose(node).y});
    // Its own stretch of path is no news: only local maps that were finished before.
    KeyframeStore memory = rounds.memory;
    while (!memory.local_maps.empty() && memory.local_maps.back().last_node >= node)
      memory.local_maps.pop_back();
    made += static_cast<std::size_t>(back_end.close(node, memory, graph).accepted);
  }
  return made;
}

TEST(BackEnd, loops_that_are_believed_are_constraints_at_the_true_poses) {
  PoseGraph graph = two_rounds().graph();
  const std::size_t before = graph.num_constraints();
  BackEnd back_end(near_maps_too());
  const std::size_t made = close_all(back_end, graph);
  EXPECT_GT(made, 3U);
  EXPECT_EQ(back_end.accepted(), made);
  ASSERT_EQ(graph.num_constraints(), before + made);
  for (std::size_t i = before; i < graph.num_constraints(); ++i) {
    const Constraint& loop = graph.constraint(i);
    EXPECT_EQ(loop.kind, Constraint::Kind::kLoop);
    const auto off = loop.from_T_to - (two_rounds().truth[loop.to] - two_rounds().truth[loop.from]);
    EXPECT_LT(std::hypot(off.x, off.y), 0.1);
  }
}

TEST(BackEnd, the_last_pass_finds_more) {
  PoseGraph graph = two_rounds().graph();
  BackEnd back_end(near_maps_too());
  const std::size_t made = close_all(back_end, graph);
  const std::size_t before = graph.num_constraints();
  back_end.run_final_search(two_rounds().memory, graph, [](double) { return true; });
  EXPECT_GT(back_end.accepted(), made);
  EXPECT_EQ(graph.num_constraints() - before, back_end.accepted() - made);
}

TEST(BackEnd, settling_switches_off_a_loop_that_the_graph_contradicts) {
  PoseGraph graph = two_rounds().graph();
  BackEnd back_end(near_maps_too());
  ASSERT_GT(close_all(back_end, graph), 0U);
  std::size_t loop = graph.num_constraints();
  for (std::size_t i = graph.num_constraints(); i-- > 0;)
    if (graph.constraint(i).kind == Constraint::Kind::kLoop) loop = i;
  ASSERT_LT(loop, graph.num_constraints());
  // The way between its ends as measured elsewhere, tightly, is half a metre longer.
  Constraint other = graph.constraint(loop);
  other.kind = Constraint::Kind::kLocalMap;
  other.from_T_to.x += 0.5;
  other.information *= 1e4;
  graph.add_constraint(other);
  SparsePoseAdjustment solver;
  const std::size_t before = back_end.accepted();
  back_end.settle(graph, solver);
  EXPECT_LT(back_end.accepted(), before);
  EXPECT_FALSE(graph.enabled(loop));
  bool told = false;
  for (const LoopRecord& record : back_end.loops())
    told |=
        record.refusal && record.refusal->reason == LoopRefusal::Reason::kContradicted;
  EXPECT_TRUE(told);
}

TEST(BackEnd, loops_that_wait_to_the_end_are_refused) {
  PoseGraph graph = two_rounds().graph();
  BackEndOptions options = near_maps_too();
  options.loop_closure.verification.wide_window_m = 0;  // every window is wide: all wait
  options.loop_consensus.min_weight = 1e6;              // and none is ever confirmed
  BackEnd back_end(options);
  EXPECT_EQ(close_all(back_end, graph), 0U);
  const auto pending = [&] {
    std::size_t count = 0;
    for (const LoopRecord& loop : back_end.loops()) count += loop.verdict == LoopVerdict::kPending ? 1 : 0;
    return count;
  };
  EXPECT_GT(pending(), 0U);
  back_end.ledger().refuse_pending();
  EXPECT_EQ(pending(), 0U);
  EXPECT_EQ(back_end.accepted(), 0U);
}

}  // namespace
}  // namespace psi_slam
