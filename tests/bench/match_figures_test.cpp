// SPDX-License-Identifier: BSD-3-Clause
#include "match/match_benchmark.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

LoopCase positive_case() {
  LoopCase one;
  one.positive = true;
  return one;
}

MatchResult match_at(double x, double phi, double response = 0.7) {
  MatchResult match;
  match.found = true;
  match.map_T_robot = {x, 0, phi};
  match.response = response;
  return match;
}

bool success(const MatchResult& match) {
  return judge(positive_case(), match, match, 0.5).success;
}

TEST(MatchFigures, success_ends_at_thirty_centimetres_and_three_and_a_half_degrees) {
  EXPECT_TRUE(success(match_at(0.3, 0)));
  EXPECT_FALSE(success(match_at(0.3001, 0)));
  EXPECT_TRUE(success(match_at(0, 0.9999 * kSuccess_rad)));
  EXPECT_TRUE(success(match_at(0, -0.9999 * kSuccess_rad)));
  EXPECT_FALSE(success(match_at(0, 1.0001 * kSuccess_rad)));
  MatchResult nothing = match_at(0, 0);
  nothing.found = false;
  EXPECT_FALSE(success(nothing));
}

TEST(MatchFigures, the_angle_to_the_truth_is_wrapped) {
  LoopCase one = positive_case();
  one.anchor_T_node = {5, -2, 3.13};
  MatchResult match = match_at(5, -3.13);
  match.map_T_robot.y = -2;
  EXPECT_TRUE(judge(one, match, match, 0.5).success);
}

TEST(MatchFigures, the_same_optimum_is_as_good_a_match_or_none_by_either) {
  const LoopCase one = positive_case();
  const MatchResult exact = match_at(0, 0, 0.7);
  MatchResult nothing;
  EXPECT_TRUE(judge(one, match_at(9, 0, 0.7), exact, 0.5).same_optimum);
  EXPECT_FALSE(judge(one, match_at(0, 0, 0.6999), exact, 0.5).same_optimum);
  EXPECT_FALSE(judge(one, nothing, exact, 0.5).same_optimum);
  EXPECT_FALSE(judge(one, exact, nothing, 0.5).same_optimum);
  EXPECT_TRUE(judge(one, nothing, nothing, 0.5).same_optimum);
}

TEST(MatchFigures, a_false_accept_is_a_negative_case_at_the_threshold) {
  const LoopCase negative;
  EXPECT_TRUE(judge(negative, match_at(0, 0, 0.5), {}, 0.5).false_accept);
  EXPECT_FALSE(judge(negative, match_at(0, 0, 0.4999), {}, 0.5).false_accept);
  EXPECT_FALSE(judge(positive_case(), match_at(0, 0, 0.9), {}, 0.5).false_accept);
  EXPECT_FALSE(judge(negative, match_at(0, 0, 0.9), {}, 0.5).success);
}

TEST(MatchFigures, agree_with_hand_computed_ones) {
  MatchTally tally;
  MatchResult match;
  match.evaluations = 10;
  tally.add(positive_case(), {true, true, false}, match, 4);
  tally.add(positive_case(), {true, false, false}, match, 1);
  match.evaluations = 70;
  match.search = SearchKind::kGenetic;
  tally.add(positive_case(), {false, false, false}, match, 2);
  tally.add(LoopCase(), {false, false, true}, match, 5);
  tally.add(LoopCase(), {}, match, 3);
  const MatchFigures figures = tally.figures();
  EXPECT_EQ(figures.cases, 5U);
  EXPECT_EQ(figures.positive, 3U);
  EXPECT_EQ(figures.negative, 2U);
  EXPECT_DOUBLE_EQ(*figures.success_rate, 2.0 / 3);
  EXPECT_DOUBLE_EQ(*figures.same_optimum_rate, 1.0 / 3);
  EXPECT_DOUBLE_EQ(*figures.false_accept_rate, 0.5);
  EXPECT_EQ(figures.searches[static_cast<std::size_t>(SearchKind::kExhaustive)], 2U);
  EXPECT_EQ(figures.searches[static_cast<std::size_t>(SearchKind::kGenetic)], 3U);
  EXPECT_DOUBLE_EQ(figures.evaluations, (2 * 10 + 3 * 70) / 5.0);
  EXPECT_DOUBLE_EQ(figures.time_ms.mean, 3);
  EXPECT_DOUBLE_EQ(figures.time_ms.p50, 3);
  EXPECT_DOUBLE_EQ(figures.time_ms.p95, 5);
}

TEST(MatchFigures, percentiles_are_values_at_their_ranks) {
  MatchTally tally;
  for (int i = 200; i >= 1; --i) tally.add(LoopCase(), {}, {}, i);
  const TimeFigures times = tally.figures().time_ms;
  EXPECT_DOUBLE_EQ(times.p50, 101);
  EXPECT_DOUBLE_EQ(times.p95, 191);
  EXPECT_DOUBLE_EQ(times.p99, 199);
}

TEST(MatchFigures, rates_without_cases_are_empty) {
  MatchTally tally;
  EXPECT_FALSE(tally.figures().success_rate);
  EXPECT_FALSE(tally.figures().false_accept_rate);
  tally.add(positive_case(), {}, {}, 1);
  EXPECT_TRUE(tally.figures().success_rate);
  EXPECT_FALSE(tally.figures().false_accept_rate);
}

}  // namespace
}  // namespace psi_slam
