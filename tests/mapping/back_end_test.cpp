// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end.h"

#include <gtest/gtest.h>

#include <algorithm>
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

/// The nodes, and the local maps that were finished before this node.
KeyframeStore finished_before(std::size_t node) {
  KeyframeStore keyframes = two_rounds().keyframes;
  while (!keyframes.local_maps.empty() && keyframes.local_maps.back().last_node >= node)
    keyframes.local_maps.pop_back();
  return keyframes;
}

/// Closes the loops of all nodes in order. Returns the number of new constraints.
std::size_t close_all(BackEnd& back_end, PoseGraph& graph) {
  std::size_t made = 0;
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) {
    back_end.move(0.15, {graph.pose(node).x, graph.pose(node).y});
    made += static_cast<std::size_t>(back_end.close(node, finished_before(node), graph).accepted);
  }
  return made;
}

TEST(BackEnd, accepted_loops_are_constraints_at_the_true_poses) {
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

// Nodes are 0.15 m apart and search once in 0.3 m, so the mean over all nodes would be half as large.
TEST(BackEnd, the_factor_averages_over_the_nodes_that_searched) {
  PoseGraph graph = two_rounds().graph();
  BackEndOptions options = near_maps_too();
  options.psi.window_frames = 1000;
  BackEnd back_end(options);
  int searches = 0;
  int accepted = 0;
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) {
    back_end.move(0.15, {graph.pose(node).x, graph.pose(node).y});
    const NodeLoops loops = back_end.close(node, finished_before(node), graph);
    searches += loops.searched ? 1 : 0;
    accepted += loops.accepted;
    EXPECT_TRUE(loops.searched || loops.effort.attempts == 0);
    ASSERT_EQ(back_end.factor().mean_loops, searches == 0 ? 0 : static_cast<double>(accepted) / searches);
  }
  EXPECT_GT(accepted, 3);
  EXPECT_LT(searches, static_cast<int>(graph.num_nodes()));
}

std::pair<MatcherKind, LoopEffort> finish(BackEnd& back_end, PoseGraph& graph, FinalProgress& progress) {
  SparsePoseAdjustment solver;
  return back_end.finish_loops(two_rounds().keyframes, graph, solver, progress);
}

TEST(BackEnd, the_final_search_finds_more) {
  PoseGraph graph = two_rounds().graph();
  BackEnd back_end(near_maps_too());
  const std::size_t made = close_all(back_end, graph);
  FinalProgress progress(back_end.options(), {});
  const auto [matcher, effort] = finish(back_end, graph, progress);
  EXPECT_EQ(matcher, MatcherKind::kGa);
  EXPECT_GT(effort.attempts, 0U);
  EXPECT_FALSE(progress.cut_short());
  EXPECT_GT(back_end.accepted(), made);
  EXPECT_EQ(graph.num_enabled_constraints() - two_rounds().graph().num_constraints(), back_end.accepted());
}

// The node searches one window in turn, and the log ends before the others have theirs.
TEST(BackEnd, wide_windows_that_wait_are_searched_at_the_end_of_a_log) {
  PoseGraph graph = two_rounds().graph();
  const std::size_t last = graph.num_nodes() - 1;
  for (const std::uint32_t constraint : graph.constraints_of(last))
    graph.set_enabled(constraint,
                      graph.constraint(constraint).from + 1 != last);  // the path does not know it
  BackEndOptions options = near_maps_too();
  options.loop_closure.attempt_distance_m = 0;
  options.final_search.passes = 0;
  BackEnd back_end(options);
  back_end.close(last, two_rounds().keyframes, graph);
  ASSERT_EQ(back_end.loops().size(), 1U);
  Constraint weak;  // keeps the graph connected
  weak.from = last - 1;
  weak.to = last;
  weak.from_T_to = graph.pose(last) - graph.pose(last - 1);
  weak.information = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  graph.add_constraint(weak);
  FinalProgress progress(options, {});
  const auto [matcher, effort] = finish(back_end, graph, progress);
  EXPECT_GT(effort.attempts, 1U);
  EXPECT_GT(back_end.loops().size(), 2U);
}

TEST(BackEnd, a_final_search_cut_short_is_reported_and_not_refined) {
  PoseGraph graph = two_rounds().graph();
  BackEnd back_end(near_maps_too());
  close_all(back_end, graph);
  int reports = 0;
  FinalProgress progress(back_end.options(), [&](double share) {
    EXPECT_LE(share, 1);
    ++reports;
    return false;
  });
  finish(back_end, graph, progress);
  EXPECT_EQ(reports, 1);
  EXPECT_TRUE(progress.cut_short());
  RefinedScans none;
  back_end.refine(none, graph, progress);
}

TEST(BackEnd, a_loop_that_the_graph_contradicts_is_rejected_at_the_end) {
  PoseGraph graph = two_rounds().graph();
  BackEndOptions options = near_maps_too();
  options.final_search.passes = 0;
  BackEnd back_end(options);
  ASSERT_GT(close_all(back_end, graph), 0U);
  std::size_t loop = graph.num_constraints();
  for (std::size_t i = graph.num_constraints(); i-- > 0;)
    if (graph.constraint(i).kind == Constraint::Kind::kLoop) loop = i;
  ASSERT_LT(loop, graph.num_constraints());
  // Contradicts the loop: a tight constraint between the same nodes that is half a metre longer.
  Constraint other = graph.constraint(loop);
  other.kind = Constraint::Kind::kLocalMap;
  other.from_T_to.x += 0.5;
  other.information *= 1e4;
  graph.add_constraint(other);
  const std::size_t before = back_end.accepted();
  FinalProgress progress(options, {});
  finish(back_end, graph, progress);
  EXPECT_LT(back_end.accepted(), before);
  EXPECT_FALSE(graph.enabled(loop));
  EXPECT_TRUE(std::any_of(back_end.loops().begin(), back_end.loops().end(), is_outlier));
}

TEST(BackEnd, candidates_at_the_end_are_rejected) {
  PoseGraph graph = two_rounds().graph();
  BackEndOptions options = near_maps_too();
  options.final_search.passes = 0;
  options.loop_closure.verification.wide_window_m = 0;  // every window is wide, so all loops are candidates
  options.loop_consensus.min_weight = 1e6;              // so high that no loop is confirmed
  BackEnd back_end(options);
  EXPECT_EQ(close_all(back_end, graph), 0U);
  const auto candidates = [&] {
    return std::count_if(back_end.loops().begin(), back_end.loops().end(),
                         [](const LoopRecord& loop) { return loop.state == LoopState::kCandidate; });
  };
  EXPECT_GT(candidates(), 0);
  FinalProgress progress(options, {});
  finish(back_end, graph, progress);
  EXPECT_EQ(candidates(), 0);
  EXPECT_EQ(back_end.accepted(), 0U);
}

TEST(OptimizationSchedule, optimises_at_once_for_a_strong_contradiction_and_after_growth_for_a_weak_one) {
  PoseGraph graph;
  for (int node = 0; node < 2000; ++node) graph.add_node({0, 0, 0});
  OptimizationSchedule schedule;
  schedule.optimized(graph);
  EXPECT_FALSE(schedule.is_due(graph));
  schedule.add_residual(OptimizationSchedule::kUrgentResidual);
  EXPECT_TRUE(schedule.is_due(graph));
  schedule.optimized(graph);
  EXPECT_FALSE(schedule.is_due(graph));
  schedule.add_residual(2);
  EXPECT_FALSE(schedule.is_due(graph));
  for (int node = 0; node < 3; ++node) graph.add_node({0, 0, 0});
  EXPECT_TRUE(schedule.is_due(graph));
}

}  // namespace
}  // namespace psi_slam
