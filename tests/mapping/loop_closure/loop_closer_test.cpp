// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_closer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <vector>

#include "matching/make_matcher.h"
#include "two_rounds.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Matcher that finds no match and records the problems it is asked to solve.
class AskedMatcher : public Matcher {
 public:
  struct Question {
    SearchExtent extent;
    MatchSeed seed;
    std::size_t points = 0;
    double min_response = 0;
  };

  MatchResult match(const MatchProblem& problem) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    questions_.push_back({problem.extent, problem.seed, problem.scan.points.size(), problem.min_response});
    MatchResult result;
    result.evaluations = 7;
    return result;
  }
  std::string name() const override { return "asked"; }
  const std::vector<Question>& questions() const { return questions_; }

 private:
  mutable std::mutex mutex_;
  mutable std::vector<Question> questions_;
};

/// Matcher that finds the centre of every window.
class CentreMatcher : public Matcher {
 public:
  MatchResult match(const MatchProblem& problem) const override {
    MatchResult result;
    result.found = true;
    result.map_T_robot = problem.map_T_robot;
    result.response = 1;
    return result;
  }
  std::string name() const override { return "centre"; }
};

LoopClosureOptions near_maps_too() {
  LoopClosureOptions options;
  options.candidates.min_travel_m = 3;
  return options;
}

LoopCloser::Outcome close(const PoseGraph& graph, const Matcher& matcher, int threads = 1,
                          const KeyframeStore& keyframes = two_rounds().keyframes) {
  WorkerPool pool(threads);
  LoopCloser closer(near_maps_too(), 5);
  return closer.close(two_rounds().node, keyframes, graph, {{MatcherKind::kCsm, matcher}}, pool);
}

TEST(LoopCloser, attempts_that_find_nothing_are_listed_and_counted) {
  const AskedMatcher matcher;
  const LoopCloser::Outcome outcome = close(two_rounds().graph(), matcher);
  EXPECT_GT(outcome.effort.attempts, 1U);
  EXPECT_EQ(outcome.loops.size(), outcome.effort.attempts);
  for (const LoopRecord& loop : outcome.loops) {
    EXPECT_EQ(loop.state, LoopState::kRejected);
    EXPECT_EQ(loop.anchor_T_node, loop.anchor_T_predicted);
    EXPECT_EQ(loop.rejection.value().reason, LoopRejection::Reason::kNothingFound);
  }
  EXPECT_EQ(outcome.effort.attempts, matcher.questions().size());
  EXPECT_EQ(outcome.effort.found, 0U);
  EXPECT_EQ(outcome.effort.evaluations, 7 * static_cast<std::int64_t>(outcome.effort.attempts));
  EXPECT_GE(outcome.effort.milliseconds, 0);
}

TEST(LoopCloser, every_match_has_a_seed_of_its_own) {
  const AskedMatcher matcher;
  close(two_rounds().graph(), matcher);
  const std::size_t scan = two_rounds().keyframes.nodes[two_rounds().node].frame;
  std::vector<std::uint64_t> local_maps;
  for (const auto& question : matcher.questions()) {
    EXPECT_EQ(question.seed.run, 5U);
    EXPECT_EQ(question.seed.scan, scan);
    local_maps.push_back(question.seed.local_map);
  }
  ASSERT_GT(local_maps.size(), 1U);
  EXPECT_EQ(std::set<std::uint64_t>(local_maps.begin(), local_maps.end()).size(), local_maps.size());
}

TEST(LoopCloser, does_not_search_for_a_scan_without_points) {
  KeyframeStore keyframes = two_rounds().keyframes;
  keyframes.nodes[two_rounds().node].points = std::make_shared<const ScanPoints>();
  const AskedMatcher matcher;
  const LoopCloser::Outcome outcome = close(two_rounds().graph(), matcher, 1, keyframes);
  EXPECT_EQ(outcome.effort.attempts, 0U);
  EXPECT_TRUE(matcher.questions().empty());
}

TEST(LoopCloser, searches_once_in_each_stretch) {
  const AskedMatcher matcher;
  WorkerPool pool(1);
  LoopCloser closer(near_maps_too(), 5);
  const TwoRounds& rounds = two_rounds();
  const auto attempts = [&](std::size_t node) {
    return closer.close(node, rounds.keyframes, rounds.graph(), {{MatcherKind::kCsm, matcher}}, pool)
        .effort.attempts;
  };
  ASSERT_FALSE(
      begins_stretch(rounds.node + 1, rounds.keyframes.nodes, LoopClosureOptions().attempt_distance_m));
  EXPECT_GT(attempts(rounds.node), 0U);
  EXPECT_EQ(attempts(rounds.node + 1), 0U);
}

TEST(LoopCloser, searches_an_unconnected_node_around_whole_local_maps) {
  const SearchExtent largest = LoopCandidateOptions().max_window;
  const AskedMatcher linked;
  close(two_rounds().graph(), linked);
  ASSERT_FALSE(linked.questions().empty());
  for (const auto& question : linked.questions()) {
    EXPECT_LT(question.extent.x_m, 1);
    EXPECT_LT(question.extent.theta_rad, largest.theta_rad);
  }

  PoseGraph graph = two_rounds().graph();
  for (const std::uint32_t constraint : graph.constraints_of(two_rounds().node))
    graph.set_enabled(constraint, false);
  const AskedMatcher apart;
  close(graph, apart);
  ASSERT_FALSE(apart.questions().empty());
  const std::vector<LoopCandidate> whole =
      far_candidates(two_rounds().node, two_rounds().keyframes, graph, near_maps_too().candidates,
                     [](const std::vector<std::size_t>& segments) {
                       const double unknown = std::numeric_limits<double>::infinity();
                       return std::vector<PositionSigma>(segments.size(), {unknown, unknown});
                     });
  for (const auto& question : apart.questions()) {
    EXPECT_TRUE(std::any_of(whole.begin(), whole.end(),
                            [&](const LoopCandidate& one) {
                              return question.extent.x_m == one.extent.x_m &&
                                     question.extent.y_m == one.extent.y_m;
                            }))
        << question.extent.x_m << ' ' << question.extent.y_m;
    EXPECT_EQ(question.extent.theta_rad, largest.theta_rad);
    EXPECT_GT(question.points, two_rounds().keyframes.nodes[two_rounds().node].points->points.size())
        << "wide windows use the context";
  }
}

TEST(LoopCloser, a_node_searches_few_wide_windows_and_the_next_nodes_the_others) {
  PoseGraph graph = two_rounds().graph();
  for (const std::uint32_t constraint : graph.constraints_of(two_rounds().node))
    graph.set_enabled(constraint, false);
  LoopClosureOptions options = near_maps_too();
  options.wide_searches = 1;
  LoopCloser closer(options, 5);
  WorkerPool pool(1);
  const AskedMatcher matcher;
  std::set<std::size_t> searched;
  for (int attempt = 0; attempt < 3; ++attempt) {
    const LoopCloser::Outcome outcome =
        closer.close(two_rounds().node, two_rounds().keyframes, graph, {{MatcherKind::kCsm, matcher}}, pool);
    ASSERT_EQ(outcome.loops.size(), 1U);
    EXPECT_TRUE(searched.insert(outcome.loops.front().local_map).second) << "every local map gets its turn";
  }
}

TEST(LoopCloser, a_match_far_from_the_prediction_has_a_small_prior) {
  LoopCandidate candidate;
  candidate.extent = {0.3, 0.3, 0.05};
  candidate.anchor_T_node = {1, 2, 0.1};
  candidate.anchor_T_predicted = {4, 6, 0.1};
  WorkerPool pool(1);
  const CentreMatcher matcher;
  const LoopCloser closer(near_maps_too(), 5);
  const auto prior = [&](double sigma_m) {
    candidate.sigma_m = sigma_m;
    return closer
        .match(two_rounds().node, candidate, two_rounds().keyframes, {{MatcherKind::kCsm, matcher}}, pool)
        .value()
        .prior;
  };
  EXPECT_DOUBLE_EQ(prior(2), path_prior(5, 2));
  EXPECT_EQ(prior(std::numeric_limits<double>::infinity()), 1) << "no path states the place";
}

TEST(LoopCloser, the_windows_that_a_node_left_are_made_up_for_at_the_end) {
  PoseGraph graph = two_rounds().graph();
  for (const std::uint32_t constraint : graph.constraints_of(two_rounds().node))
    graph.set_enabled(constraint, false);
  LoopCloser closer(near_maps_too(), 5);
  WorkerPool pool(1);
  const AskedMatcher matcher;
  const NodeMatchers matchers = {{MatcherKind::kCsm, matcher}};
  const KeyframeStore& keyframes = two_rounds().keyframes;
  const LoopCloser::Outcome first = closer.close(two_rounds().node, keyframes, graph, matchers, pool);
  ASSERT_EQ(first.loops.size(), 1U);
  const std::size_t known = first.loops.front().local_map;
  const LoopCloser::Outcome others =
      closer.close_wide(two_rounds().node, keyframes, graph, matchers, pool,
                        [&](std::size_t local_map) { return local_map == known; });
  EXPECT_GT(others.loops.size(), 1U);
  EXPECT_LE(others.loops.size(), 8U);
  for (const LoopRecord& loop : others.loops) EXPECT_NE(loop.local_map, known);
}

TEST(LoopCloser, a_search_by_hand_reports_lower_responses_of_wide_windows) {
  LoopCandidate candidate;
  candidate.local_map = 0;
  candidate.extent = LoopCandidateOptions().max_window;
  ASSERT_TRUE(is_wide(candidate.extent, {}));
  const AskedMatcher matcher;
  WorkerPool pool(1);
  const LoopCloser closer(near_maps_too(), 5);
  closer.match(two_rounds().node, candidate, two_rounds().keyframes, {{MatcherKind::kCsm, matcher}}, pool);
  ASSERT_EQ(matcher.questions().size(), 1U);
  EXPECT_DOUBLE_EQ(matcher.questions().front().min_response, least_response_by_hand(candidate.extent, {}));
  EXPECT_LT(matcher.questions().front().min_response, LoopVerificationOptions().min_context_response);

  PoseGraph graph = two_rounds().graph();
  for (const std::uint32_t constraint : graph.constraints_of(two_rounds().node))
    graph.set_enabled(constraint, false);
  const AskedMatcher asked;
  close(graph, asked);
  ASSERT_FALSE(asked.questions().empty());
  for (const auto& question : asked.questions())
    EXPECT_EQ(question.min_response, LoopVerificationOptions().min_context_response);
}

TEST(LoopCloser, effort_is_divided_by_the_matchers_of_small_and_large_windows) {
  PoseGraph graph = two_rounds().graph();
  for (const std::uint32_t constraint : graph.constraints_of(two_rounds().node))
    graph.set_enabled(constraint, false);
  const AskedMatcher small;
  const AskedMatcher large;
  NodeMatchers matchers = {{MatcherKind::kCsm, small}};
  matchers.of_large_windows.emplace(ChosenMatcher{MatcherKind::kGa, large});
  matchers.max_poses = 1e5;
  WorkerPool pool(1);
  LoopCloser closer(near_maps_too(), 5);
  const std::size_t node = two_rounds().node;
  const auto narrow = closer.close(node, two_rounds().keyframes, two_rounds().graph(), matchers, pool);
  EXPECT_FALSE(small.questions().empty());
  EXPECT_TRUE(large.questions().empty());
  EXPECT_EQ(narrow.effort_of.at(MatcherKind::kCsm).attempts, small.questions().size());
  const auto wide = closer.close(node, two_rounds().keyframes, graph, matchers, pool);
  ASSERT_FALSE(large.questions().empty());
  EXPECT_EQ(wide.effort_of.at(MatcherKind::kGa).attempts, large.questions().size());
  for (const LoopRecord& loop : wide.loops) EXPECT_EQ(loop.matcher, MatcherKind::kGa);
}

// Both runs begin with a search of the newest local maps.
TEST(LoopCloser, a_run_whose_place_is_unknown_searches_the_newest_local_maps_first) {
  KeyframeStore keyframes = two_rounds().keyframes;
  const std::size_t node = two_rounds().node;
  const std::size_t count = whole_map_candidates(node, keyframes, two_rounds().graph(), {}).size();
  ASSERT_GT(count, 3U);
  LoopCloser closer(near_maps_too(), 5);
  WorkerPool pool(1);
  const AskedMatcher matcher;
  for (const std::size_t begin : {node - 1, node}) {
    keyframes.unplaced = {{begin, std::numeric_limits<std::size_t>::max(), 0}};
    const std::size_t newest =
        whole_map_candidates(node, keyframes, two_rounds().graph(), {}).back().local_map;
    for (int attempt = 0; attempt < 3; ++attempt) {
      const LoopCloser::Outcome outcome =
          closer.close(node, keyframes, two_rounds().graph(), {{MatcherKind::kCsm, matcher}}, pool);
      ASSERT_EQ(outcome.loops.size(), 1U) << "one whole local map";
      EXPECT_EQ(outcome.loops.front().window.theta_rad, M_PI);
      if (attempt % 2 == 0) {
        EXPECT_GE(outcome.loops.front().local_map + 1, newest);
      }
    }
  }
}

// Drift has moved the node in the graph farther from its true place than the largest window reaches.
TEST(LoopCloser, finds_a_place_that_drift_has_moved_out_of_the_largest_window) {
  PoseGraph graph;
  for (const TPose2D& pose : two_rounds().truth) graph.add_node(pose);
  const PoseGraph exact = two_rounds().graph();
  for (Constraint step : exact.constraints()) {
    step.information = Eigen::Vector3d(1, 1, 1e4).asDiagonal();  // large errors, because the path is short
    graph.add_constraint(step);
  }
  const std::size_t node = two_rounds().node;
  const TPose2D truth = graph.pose(node);
  graph.set_pose(node, {truth.x + 20, truth.y - 15, truth.phi});
  const KeyframeStore& keyframes = two_rounds().keyframes;
  const CorrelativeMatcher matcher({});
  LoopCloser closer(near_maps_too(), 5);
  WorkerPool pool(1);
  bool found = false;
  for (int attempt = 0; attempt < 8 && !found; ++attempt) {
    for (const LoopRecord& loop :
         closer.close(node, keyframes, graph, {{MatcherKind::kCsm, matcher}}, pool).loops) {
      if (loop.state != LoopState::kCandidate) continue;
      const TPose2D pose = graph.pose(loop.anchor) + loop.anchor_T_node;
      EXPECT_NEAR(pose.x, truth.x, 0.3);
      EXPECT_NEAR(pose.y, truth.y, 0.3);
      found = true;
    }
  }
  EXPECT_TRUE(found);
}

TEST(LoopCloser, finds_the_same_loops_with_any_number_of_threads) {
  const CorrelativeMatcher matcher({});
  const PoseGraph graph = two_rounds().graph();
  const LoopCloser::Outcome alone = close(graph, matcher, 1);
  ASSERT_GT(alone.loops.size(), 1U);
  EXPECT_TRUE(std::any_of(alone.loops.begin(), alone.loops.end(),
                          [](const LoopRecord& loop) { return loop.state == LoopState::kAccepted; }));
  for (const int threads : {2, 4}) {
    const LoopCloser::Outcome together = close(graph, matcher, threads);
    EXPECT_EQ(together.effort.evaluations, alone.effort.evaluations);
    ASSERT_EQ(together.loops.size(), alone.loops.size());
    for (std::size_t i = 0; i < alone.loops.size(); ++i) {
      EXPECT_EQ(together.loops[i].local_map, alone.loops[i].local_map);
      EXPECT_EQ(together.loops[i].anchor_T_node, alone.loops[i].anchor_T_node);
      EXPECT_EQ(text_of(together.loops[i].rejection), text_of(alone.loops[i].rejection));
    }
  }
}

}  // namespace
}  // namespace psi_slam
