// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/final_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "matching/make_matcher.h"
#include "two_rounds.h"

namespace psi_slam {
namespace {

using Known = std::function<bool(std::size_t, std::size_t)>;

const CorrelativeMatcher kExact({});

FinalSearchOutcome pass(
    int threads, const Known& known = [](std::size_t, std::size_t) { return false; },
    const std::function<bool(double)>& progress = [](double) { return true; }) {
  WorkerPool pool(threads);
  return final_search(two_rounds().keyframes, two_rounds().graph(), {{MatcherKind::kCsm, kExact}}, {}, {},
                      known, 1, pool, progress);
}

TEST(FinalSearch, finds_true_loops_and_nothing_else) {
  const FinalSearchOutcome outcome = pass(1);
  std::size_t accepted = 0;
  for (const LoopRecord& loop : outcome.loops) {
    EXPECT_TRUE(loop.in_final_search);
    if (loop.verdict != LoopVerdict::kAccepted) continue;
    ++accepted;
    const auto off = loop.anchor_T_node - (two_rounds().truth[loop.node] - two_rounds().truth[loop.anchor]);
    EXPECT_LT(std::hypot(off.x, off.y), 0.1);
  }
  EXPECT_GT(accepted, 10U);
}

// Counts the pairs within reach by testing every pair, and compares the counts.
TEST(FinalSearch, matches_all_pairs_near_each_other) {
  const TwoRounds& rounds = two_rounds();
  const PoseGraph graph = rounds.graph();
  std::size_t near_pairs = 0;
  FinalSearchOptions options;
  options.reach_m = 1.5;
  options.travel_m = 0;
  for (const PlacedLocalMap& local_map : rounds.keyframes.local_maps) {
    for (std::size_t node = 0; node < rounds.keyframes.nodes.size(); ++node) {
      if (node >= local_map.first_node && node <= local_map.last_node) continue;
      bool near = false;
      for (std::size_t other = local_map.first_node; other <= local_map.last_node; ++other)
        near = near || std::hypot(graph.pose(node).x - graph.pose(other).x,
                                  graph.pose(node).y - graph.pose(other).y) <= options.reach_m;
      near_pairs += near ? 1 : 0;
    }
  }
  WorkerPool pool(1);
  const FinalSearchOutcome outcome = final_search(
      rounds.keyframes, graph, {{MatcherKind::kCsm, kExact}}, {}, options,
      [](std::size_t, std::size_t) { return false; }, 1, pool, [](double) { return true; });
  EXPECT_EQ(outcome.effort.attempts, near_pairs);
  EXPECT_LT(near_pairs, rounds.keyframes.nodes.size() * rounds.keyframes.local_maps.size() / 2);
}

// Every local map is matched with one node in each stretch, and successive nodes with different local maps.
TEST(FinalSearch, matches_one_node_in_each_stretch_of_travel_with_a_local_map) {
  const TwoRounds& rounds = two_rounds();
  FinalSearchOptions options;
  options.travel_m = 1;
  std::vector<double> moved_m{0};
  for (std::size_t node = 1; node < rounds.keyframes.nodes.size(); ++node) {
    const auto motion =
        rounds.keyframes.nodes[node].local_T_robot - rounds.keyframes.nodes[node - 1].local_T_robot;
    moved_m.push_back(moved_m.back() + std::hypot(motion.x, motion.y) +
                      kTravelOfTurn_m * std::abs(motion.phi));
  }
  double longest_step_m = 0;
  for (std::size_t node = 1; node < moved_m.size(); ++node)
    longest_step_m = std::max(longest_step_m, moved_m[node] - moved_m[node - 1]);
  ASSERT_LT(longest_step_m, options.travel_m / 2) << "a stretch has at least two nodes";

  // Collects the pairs that the search asks about. Answers that all are known, so it matches none.
  std::map<std::size_t, std::vector<std::size_t>> nodes_of;
  std::set<std::size_t> matched;
  WorkerPool pool(1);
  options.reach_m = 1000;
  final_search(
      rounds.keyframes, rounds.graph(), {{MatcherKind::kCsm, kExact}}, {}, options,
      [&](std::size_t node, std::size_t local_map) {
        nodes_of[local_map].push_back(node);
        matched.insert(node);
        return true;
      },
      1, pool, [](double) { return true; });
  ASSERT_EQ(nodes_of.size(), rounds.keyframes.local_maps.size());
  for (const auto& [local_map, nodes] : nodes_of) {
    const PlacedLocalMap& own = rounds.keyframes.local_maps[local_map];
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      if (nodes[i - 1] == 0) continue;
      if (nodes[i - 1] < own.first_node && nodes[i] > own.last_node) continue;  // its own nodes are between
      const double between_m = moved_m[nodes[i]] - moved_m[nodes[i - 1]];
      EXPECT_NEAR(between_m, options.travel_m, longest_step_m);
    }
  }
  EXPECT_GT(matched.size(), rounds.keyframes.nodes.size() / 2) << "different local maps, different nodes";
}

TEST(FinalSearch, counts_the_matches_that_it_found) {
  const FinalSearchOutcome outcome = pass(2);
  EXPECT_EQ(outcome.effort.found, outcome.loops.size());
  for (const LoopRecord& loop : outcome.loops) EXPECT_EQ(loop.matcher, MatcherKind::kCsm);
}

TEST(FinalSearch, leaves_out_known_pairs) {
  const FinalSearchOutcome all = pass(1);
  const FinalSearchOutcome some =
      pass(1, [](std::size_t node, std::size_t local_map) { return local_map == 0 || node < 20; });
  std::size_t expected = 0;
  for (const LoopRecord& loop : all.loops) expected += loop.local_map != 0 && loop.node >= 20 ? 1 : 0;
  EXPECT_EQ(some.loops.size(), expected);
  EXPECT_LT(some.loops.size(), all.loops.size());
  for (const LoopRecord& loop : some.loops) EXPECT_TRUE(loop.local_map != 0 && loop.node >= 20);
}

TEST(FinalSearch, finds_the_same_in_the_same_order_with_any_number_of_threads) {
  const FinalSearchOutcome alone = pass(1);
  EXPECT_TRUE(
      std::is_sorted(alone.loops.begin(), alone.loops.end(), [](const LoopRecord& a, const LoopRecord& b) {
        return std::pair(a.local_map, a.node) < std::pair(b.local_map, b.node);
      }));
  for (const int threads : {2, 4}) {
    const FinalSearchOutcome together = pass(threads);
    ASSERT_EQ(together.loops.size(), alone.loops.size());
    for (std::size_t i = 0; i < alone.loops.size(); ++i) {
      EXPECT_EQ(together.loops[i].node, alone.loops[i].node);
      EXPECT_EQ(together.loops[i].anchor_T_node, alone.loops[i].anchor_T_node);
      EXPECT_EQ(together.loops[i].verdict, alone.loops[i].verdict);
    }
    EXPECT_EQ(together.effort.evaluations, alone.effort.evaluations);
  }
}

TEST(FinalSearch, progress_reaches_the_end_even_without_pairs) {
  for (const bool nothing : {false, true}) {
    std::vector<double> shares;
    const auto known = [&](std::size_t, std::size_t) { return nothing; };
    const FinalSearchOutcome outcome = pass(2, known, [&](double share) {
      shares.push_back(share);
      return true;
    });
    EXPECT_EQ(outcome.loops.empty(), nothing);
    ASSERT_FALSE(shares.empty());
    EXPECT_GT(shares.front(), 0);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
  }
}

TEST(FinalSearch, ends_when_stopped) {
  const auto nothing_known = [](std::size_t, std::size_t) { return false; };
  int calls = 0;
  const FinalSearchOutcome cut = pass(2, nothing_known, [&](double) {
    ++calls;
    return false;
  });
  EXPECT_EQ(calls, 1);
  EXPECT_LE(cut.loops.size(), pass(2, nothing_known).loops.size());
}

}  // namespace
}  // namespace psi_slam
