// SPDX-License-Identifier: BSD-3-Clause
#include "match/exact_benchmark.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "command_fixture.h"
#include "office_log.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

TEST(ExactBenchmark, both_searches_agree_in_the_office) {
  CaseOptions options = office_cases();
  options.count = 4;
  const std::vector<LoopCase> cases = draw_cases(office_log(), options);
  ASSERT_EQ(cases.size(), 8U);
  for (const double min_response : {0.0, 0.6}) {
    const ExactBenchmarkRow row = search_exactly(cases, options, office_log().options, min_response, 1);
    EXPECT_EQ(row.count, 8U);
    EXPECT_EQ(row.equal, 8U);
    EXPECT_GE(row.found, 4U) << "the positive cases";
    EXPECT_EQ(row.found == 8U, min_response == 0) << "a threshold rejects negative cases";
    EXPECT_GT(row.csm_evaluations, 0);
    EXPECT_GT(row.depth_first_evaluations, 0);
    for (const SearchTimes& times : {row.csm, row.csm_ambiguity, row.depth_first})
      EXPECT_LE(times.mean_ms, times.max_ms);
  }
}

TEST(ExactReport, shows_times_and_ratios) {
  ExactBenchmark benchmark;
  ExactBenchmarkRow row;
  row.cases = "loop";
  row.min_response = 0.4;
  row.count = row.equal = 100;
  row.found = 99;
  row.csm = {2, 5};
  row.csm_ambiguity = {3, 7.5};
  row.depth_first = {9, 40};
  row.csm_evaluations = 70'000;
  row.depth_first_evaluations = 50'000;
  benchmark.rows = {row, row};
  benchmark.rows[1].min_response = 0;
  benchmark.maximum_grids_ms = 13;
  const BenchReport report = exact_report(benchmark, {}, "a machine");
  EXPECT_EQ(report.page, "exact-search.md");
  EXPECT_THAT(
      report.markdown,
      AllOf(HasSubstr("| loop | 0.4 | 100 | 99 | 100 | 2.00 / 5.0 | 3.00 / 7.5 | 9.00 / 40.0 | × 4.5 | "
                      "70000 | 50000 |"),
            HasSubstr("| loop | none | "), HasSubstr("13.0 ms for each local map")));
  const Json json = Json::parse(report.json);
  EXPECT_EQ(json["schema"], "psi-slam-exact-search");
  EXPECT_EQ(json["maximum_grids_ms"], 13);
  EXPECT_EQ(json["rows"][0]["csm_ms"]["mean"], 2);
  EXPECT_EQ(json["rows"][0]["depth_first_ms"]["max"], 40);
  EXPECT_EQ(json["rows"][1]["min_response"], 0);
  EXPECT_THAT(report.csv, HasSubstr("csm_ambiguity_ms.max"));
}

class ExactSearchCommand : public BenchCommand {
 protected:
  ExactSearchCommand() : BenchCommand("exact-search") {}
};

TEST_F(ExactSearchCommand, wrong_usage_and_input_give_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal({}), HasSubstr("there is no log in " + data_.string()));
  EXPECT_THAT(refusal({"--cases", "0"}), HasSubstr("--cases"));
  EXPECT_THAT(refusal({"--repeats", "none"}), HasSubstr("--repeats"));
}

}  // namespace
}  // namespace psi_slam
