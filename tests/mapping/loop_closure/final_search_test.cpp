// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/final_search.h"

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
    if (loop.state != LoopState::kAccepted) continue;
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

std::size_t attempts(double travel_m, double reach_m) {
  FinalSearchOptions options;
  options.travel_m = travel_m;
  options.reach_m = reach_m;
  WorkerPool pool(1);
  return final_search(
             two_rounds().keyframes, two_rounds().graph(), {{MatcherKind::kCsm, kExact}}, {}, options,
             [](std::size_t, std::size_t) { return false; }, 1, pool, [](double) { return true; })
      .effort.attempts;
}

TEST(FinalSearch, matches_one_node_in_each_stretch_where_many_local_maps_are_near) {
  const TwoRounds& rounds = two_rounds();
  constexpr double kTravel_m = 1;
  std::vector<double> moved_m{0};
  double longest_step_m = 0;
  for (std::size_t node = 1; node < rounds.keyframes.nodes.size(); ++node) {
    const double step_m = travel_and_turn_m(rounds.keyframes.nodes[node - 1].local_T_robot,
                                            rounds.keyframes.nodes[node].local_T_robot);
    longest_step_m = std::max(longest_step_m, step_m);
    moved_m.push_back(moved_m.back() + step_m);
  }
  ASSERT_LT(longest_step_m, kTravel_m / 2) << "a stretch has at least two nodes";

  FinalSearchOptions options;
  options.travel_m = kTravel_m;
  options.reach_m = 1000;
  ASSERT_GT(rounds.keyframes.local_maps.size(), kFewMaps + 1U);
  WorkerPool pool(1);
  const FinalSearchOutcome outcome = final_search(
      rounds.keyframes, rounds.graph(), {{MatcherKind::kCsm, kExact}}, {}, options,
      [](std::size_t, std::size_t) { return false; }, 1, pool, [](double) { return true; });
  const auto has_many_near = [&](std::size_t node) {
    int near = 0;
    for (const PlacedLocalMap& map : rounds.keyframes.local_maps)
      near += node < map.first_node || node > map.last_node ? 1 : 0;
    return near > kFewMaps;
  };
  std::map<std::size_t, std::size_t> last_node_of;  // key: local map
  std::set<std::size_t> matched;
  for (const LoopRecord& loop : outcome.loops) {
    if (loop.node == 0 || !has_many_near(loop.node)) continue;
    matched.insert(loop.node);
    const auto last = last_node_of.find(loop.local_map);
    if (last != last_node_of.end()) {
      EXPECT_GT(moved_m[loop.node] - moved_m[last->second], kTravel_m - longest_step_m);
    }
    last_node_of[loop.local_map] = loop.node;
  }
  EXPECT_GT(static_cast<double>(matched.size()), moved_m.back() / kTravel_m)
      << "different local maps are matched with different nodes";
  EXPECT_LT(outcome.effort.attempts, attempts(0, 1000));
}

TEST(FinalSearch, matches_every_node_where_few_local_maps_are_near) {
  constexpr double kReach_m = 0.5;
  EXPECT_GT(attempts(0, kReach_m), 100U);
  EXPECT_EQ(attempts(1, kReach_m), attempts(0, kReach_m));
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
      EXPECT_EQ(together.loops[i].state, alone.loops[i].state);
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
