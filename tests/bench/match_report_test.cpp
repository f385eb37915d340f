// SPDX-License-Identifier: BSD-3-Clause
#include "match/match_benchmark.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using OrderedJson = nlohmann::ordered_json;

MatchSeries series_of(double csm_ms, double ga_ms) {
  MatchSeries series;
  series.title = "some title";
  LoopCase positive;
  positive.positive = true;
  MatchResult match;
  match.evaluations = 1000;
  MatchTally csm;
  csm.add(positive, {true, true, false}, match, csm_ms);
  MatchTally ga;
  match.search = SearchKind::kGenetic;
  ga.add(positive, {true, false, false}, match, ga_ms);
  series.rows = {{"csm", csm}, {"ga", ga}};
  return series;
}

MatchBenchmark benchmark() {
  MatchBenchmark result;
  result.logs = {{"intel", "0123", 0.019, 250, 250, "", true},
                 {"odd", "4567", {}, 0, 0, "left out: why", false}};
  result.scans = series_of(4, 1);
  result.contexts = series_of(10, 2);
  return result;
}

std::vector<std::string> keys_of(const OrderedJson& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

TEST(MatchReport, json_has_a_row_for_each_matcher) {
  const OrderedJson json = OrderedJson::parse(match_report(benchmark(), {}, "a machine").json);
  ASSERT_EQ(json["matchers"].size(), 2U);
  const OrderedJson& row = json["matchers"][1];
  EXPECT_THAT(keys_of(row), testing::ElementsAre("series", "matcher", "cases", "success_rate",
                                                 "same_optimum_rate", "false_accept_rate", "evaluations",
                                                 "time_ms", "loop_time_ms", "no_loop_time_ms", "searches"));
  EXPECT_THAT(keys_of(row["time_ms"]), testing::ElementsAre("mean", "p50", "p95", "p99", "max"));
  EXPECT_EQ(row["matcher"], "ga");
  EXPECT_EQ(row["searches"]["genetic"], 1);
  EXPECT_EQ(row["searches"]["branch_and_bound"], 0);
  EXPECT_EQ(row["cases"], 1);
  EXPECT_EQ(row["success_rate"], 1.0);
  EXPECT_EQ(row["same_optimum_rate"], 0.0);
  EXPECT_TRUE(row["false_accept_rate"].is_null()) << "there was no negative case";
  EXPECT_EQ(row["evaluations"], 1000.0);
  EXPECT_EQ(row["time_ms"]["p95"], 1.0);
}

TEST(MatchReport, json_names_machine_options_and_logs) {
  MatchBenchmarkOptions options;
  options.seed = 77;
  const OrderedJson json = OrderedJson::parse(match_report(benchmark(), options, "a machine").json);
  EXPECT_EQ(json["machine"], "a machine");
  EXPECT_EQ(json["seed"], 77);
  EXPECT_EQ(json["window_m"], 8.0);
  EXPECT_EQ(json["window_deg"], 30.0);
  EXPECT_EQ(json["logs"][0]["translation_error_m"], 0.019);
  EXPECT_TRUE(json["logs"][1]["translation_error_m"].is_null());
  EXPECT_EQ(json["logs"][1]["used"], false);
  EXPECT_EQ(json["context"]["matchers"][0]["time_ms"]["mean"], 10.0);
  EXPECT_FALSE(json.contains("windows"));
}

TEST(MatchReport, markdown_has_the_rows_and_the_ratios) {
  const std::string page = match_report(benchmark(), {}, "a machine").markdown;
  EXPECT_THAT(page, AllOf(HasSubstr("a machine"), HasSubstr("| intel | `0123` | 0.019 | 250 | 250 |  |\n"),
                          HasSubstr("| odd | `4567` | – | 0 | 0 | left out: why |\n"),
                          HasSubstr("| csm | 1 | 100.0 | 100.0 | – | 1000 | 4.000 | 4.000 | 4.000 | 4.000 | "
                                    "4.000 | exhaustive |\n"),
                          HasSubstr("| ga | 1 | 100.0 | 0.0 | – | 1000 | 1.000 | 1.000 | 1.000 | 1.000 | "
                                    "1.000 | genetic |\n"),
                          HasSubstr("| ga | × 1.000 | × 0.25 | × 0.25 |\n"), Not(HasSubstr("half-width |"))));
}

TEST(MatchReport, windows_tell_loops_from_places_without) {
  MatchBenchmark result = benchmark();
  for (const double window_deg : {30.0, 180.0}) {
    for (const double window_m : {2.0, 4.0}) {
      MatchSeries series = series_of(40, 2);
      series.title = "window " + std::to_string(result.windows.size());
      series.cases.window_m = window_m;
      series.cases.window_rad = window_deg * M_PI / 180;
      series.rows[0].tally.add({}, {}, {}, 60);
      series.rows[0].tally.add({}, {}, {}, 80);
      result.windows.push_back(series);
    }
  }
  MatchSeries failed = result.windows.front();
  failed.title = "context";
  failed.cases.context = true;
  LoopCase positive;
  positive.positive = true;
  failed.rows[1].tally.add(positive, {}, {}, 1);
  result.windows.push_back(failed);
  const BenchReport report = match_report(result, {}, "a machine");
  EXPECT_THAT(report.markdown,
              AllOf(HasSubstr("| window 1 | csm | 1 | 100.0 | × 1.000 | 40.0 / 40.0 | 2 | 70.0 / 80.0 |\n"),
                    HasSubstr("| context | ga | 2 | 50.0 | × 0.500 | 1.5 / 2.0 | 0 |")));
  const OrderedJson json = OrderedJson::parse(report.json);
  EXPECT_EQ(json["windows"][3]["window_deg"], 180);
  EXPECT_EQ(json["windows"][4]["context"], true);
  EXPECT_EQ(json["windows"][1]["matchers"][0]["no_loop_time_ms"]["max"], 80);
  EXPECT_THAT(report.csv, HasSubstr("window 1,csm,3,1.0,1.0,0.0,333.3,60.0,"));
  ASSERT_EQ(report.plots.size(), 2U);
  EXPECT_THAT(report.plots[0].content,
              AllOf(HasSubstr("window 2</text>"), HasSubstr("window 3</text>"), HasSubstr(">ga</text>"),
                    Not(HasSubstr("window 0</text>")), Not(HasSubstr("nan"))));
}

}  // namespace
}  // namespace psi_slam
