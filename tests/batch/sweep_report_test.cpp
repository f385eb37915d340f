// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "well_formed.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

SweepOutcome done(double error_m) {
  SweepFigures figures;
  figures.has_errors = true;
  figures.errors.translation_abs_m.mean = error_m;
  figures.errors.rotation_abs_deg.mean = 1;
  figures.loops_accepted = 12;
  figures.wall_s = 3.5;
  return {figures, {}, 1};
}

class SweepReportTest : public testing::Test {
 protected:
  SweepReportTest() {
    plan_.logs = {{"a", "a.log", {}, {}, "sha", 1, {}}};
    plan_.columns = {"map.resolution_m"};
    for (const char* value : {"0.1", "0.2"})
      for (const std::uint64_t seed : {1, 2})
        plan_.runs.push_back({0, {value}, seed, {}, "key", "a-" + std::string(value) + std::to_string(seed)});
    result_.outcomes = {done(0.1), done(0.3), done(0.5), SweepOutcome{{}, "it broke, \"so\" <it> |said", 2}};
  }

  SweepPlan plan_;
  SweepResult result_;
};

TEST_F(SweepReportTest, csv_has_a_line_for_each_run_with_times_last) {
  const std::string csv = sweep_csv(plan_, result_);
  EXPECT_THAT(csv, HasSubstr("a,0.1,2,done,0.300000,0.000000,1.000000,"));
  EXPECT_THAT(csv, HasSubstr(",runs/a-0.12,,3.500,0.000,0.0\n"));
  EXPECT_THAT(csv,
              HasSubstr("a,0.2,2,failed,,,,,,,,,,,runs/a-0.22,\"it broke, \"\"so\"\" <it> |said\",,,\n"));
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  EXPECT_EQ(commas(csv.substr(0, csv.find('\n'))), 18);
}

TEST_F(SweepReportTest, markdown_has_means_by_setting_and_marks_the_best) {
  EXPECT_THAT(sweep_markdown(plan_, result_),
              AllOf(HasSubstr("| a | 0.1 | 2 | **0.2000 ± 0.1414** | **1.000 ± 0.000** |"),
                    HasSubstr("| a | 0.2 | 1 of 2 | 0.5000 | **1.000** |"), HasSubstr("1 run failed"),
                    HasSubstr("| a-0.22 | 2 | it broke, \"so\" <it> /said |")));
}

TEST_F(SweepReportTest, without_relations_nothing_is_best) {
  for (auto& outcome : result_.outcomes)
    if (outcome->figures) outcome->figures->has_errors = false;
  EXPECT_THAT(sweep_markdown(plan_, result_),
              AllOf(HasSubstr("| a | 0.1 | 2 | – | – |"), Not(HasSubstr("**"))));
  EXPECT_THAT(sweep_csv(plan_, result_), HasSubstr("a,0.1,1,done,,,,,,0,0,12,"));
}

TEST_F(SweepReportTest, counts_the_runs_that_are_not_made_yet) {
  result_.outcomes[1].reset();
  EXPECT_EQ(result_.to_go(), 1U);
  EXPECT_THAT(sweep_markdown(plan_, result_), HasSubstr("1 not made yet"));
  EXPECT_THAT(sweep_csv(plan_, result_), HasSubstr("a,0.1,2,to go,"));
}

TEST_F(SweepReportTest, the_page_is_well_formed_and_the_json_complete) {
  const std::string html = sweep_html(plan_, result_);
  EXPECT_EQ(complaint_about(html.substr(html.find("<html"))), "");
  EXPECT_THAT(html, HasSubstr("<td class=\"best\">0.2000 ± 0.1414</td>"));
  const auto json = nlohmann::json::parse(sweep_json(plan_, result_));
  EXPECT_EQ(json["runs"].size(), 4U);
  EXPECT_EQ(json["runs"][0]["figures"]["errors"]["translation_abs_m"]["mean"], 0.1);
  EXPECT_EQ(json["runs"][3]["state"], "failed");
}

}  // namespace
}  // namespace psi_slam
