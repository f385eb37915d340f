// SPDX-License-Identifier: BSD-3-Clause
#include "match/match_benchmark.h"

#include <gmock/gmock.h>

#include "office_log.h"

namespace psi_slam {
namespace {

/// Matcher that adds its name to `calls` and checks the options of the problem. It finds no match.
class NotedMatcher : public Matcher {
 public:
  NotedMatcher(std::string name, std::vector<std::string>& calls) : name_(std::move(name)), calls_(calls) {}
  MatchResult match(const MatchProblem& problem) const override {
    calls_.push_back(name_);
    EXPECT_DOUBLE_EQ(problem.min_response, 0.8 * 0.5);
    EXPECT_TRUE(problem.measure_ambiguity);
    EXPECT_DOUBLE_EQ(problem.extent.x_m, 1);
    EXPECT_DOUBLE_EQ(problem.extent.theta_rad, 0.3);
    return {};
  }
  std::string name() const override { return name_; }

 private:
  std::string name_;
  std::vector<std::string>& calls_;
};

TEST(MatchBenchmark, alternates_between_candidates_case_by_case) {
  CaseOptions options = office_cases();
  options.count = 1;
  std::vector<LoopCase> cases = draw_cases(office_log(), options);
  ASSERT_EQ(cases.size(), 2U);
  std::vector<std::string> calls;
  const auto a = std::make_shared<NotedMatcher>("a", calls);
  const auto b = std::make_shared<NotedMatcher>("b", calls);
  MatchSeries series;
  series.cases = options;
  int told = 0;
  run_cases(cases, {{"a", a}, {"b", b}}, 0.5, series, [&told] { ++told; });
  EXPECT_THAT(calls, testing::ElementsAre("a", "b", "b", "a"));
  EXPECT_EQ(told, 2);
  ASSERT_EQ(series.rows.size(), 2U);
  EXPECT_EQ(series.rows[1].matcher, "b");
  EXPECT_EQ(series.rows[1].tally.figures().cases, 2U);
}

TEST(MatchBenchmark, exact_matching_finds_the_loops_of_the_office) {
  const CaseOptions options = office_cases();
  const std::vector<MatchCandidate> all_candidates = match_candidates(office_log().options);
  MatchSeries series;
  series.cases = options;
  run_cases(draw_cases(office_log(), options), all_candidates, 0.5, series, [] {});
  const MatchFigures csm = series.rows.front().tally.figures();
  EXPECT_EQ(series.rows.front().matcher, "csm");
  EXPECT_EQ(csm.cases, 24U);
  EXPECT_GE(*csm.success_rate, 0.9);
  EXPECT_EQ(*csm.same_optimum_rate, 1);
  EXPECT_GT(csm.evaluations, 0);
  EXPECT_GT(csm.time_ms.p99, 0);
}

TEST(MatchBenchmark, compares_both_genetic_searches) {
  std::vector<std::string> names;
  for (const MatchCandidate& candidate : match_candidates(MapperOptions())) names.push_back(candidate.name);
  EXPECT_THAT(names, testing::ElementsAre("csm", "csm_ga", "ga", "csm_ga_paper", "ga_paper"));
}

}  // namespace
}  // namespace psi_slam
