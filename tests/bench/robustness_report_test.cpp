// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/robustness_benchmark.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "well_formed.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

RobustnessRow row(const std::string& log, const std::string& series, const std::string& name,
                  double error_m) {
  RobustnessRow row;
  row.log = log;
  row.degraded.series = series;
  row.degraded.name = name;
  row.translation_error_m = error_m;
  row.rotation_error_deg = 0.5;
  row.relations = 100;
  row.scans = 3600;
  row.unmatched = 2;
  row.loops = 1000;
  row.loop_precision = 0.995;
  return row;
}

RobustnessBenchmark two_logs() {
  RobustnessBenchmark benchmark;
  for (const char* log : {"aces", "<intel>"}) {
    benchmark.identities.push_back({log, "a0a0", "b0b0"});
    benchmark.logs.push_back({log, {0.05, M_PI / 180, M_PI / 90}});
    benchmark.rows.push_back(row(log, "scans kept", "1 of 1", 0.0412));
    benchmark.rows.push_back(row(log, "scans kept", "1 of 2", 0.2));
    benchmark.rows.push_back(row(log, "scans kept", "1 of 2", 0.4));
    benchmark.rows.back().seed = 8;
    benchmark.rows.back().loop_precision.reset();
    benchmark.rows.push_back(row(log, "field of view", "full", 0.0412));
  }
  return benchmark;
}

TEST(RobustnessReport, markdown_has_the_figures) {
  const std::string page = robustness_report(two_logs(), {7, 8}, "a machine").markdown;
  EXPECT_THAT(page, HasSubstr("a machine; seeds 7 to 8"));
  EXPECT_THAT(page, HasSubstr("| aces | 0.0500 | 1.000 | 2.000 |\n"));
  EXPECT_THAT(
      page,
      HasSubstr("| aces | scans kept | 1 of 1 | 1 | 0.0412 | 0.500 | 100 | 1000 | 99.5 | – | 2 of 3600 |\n"));
}

TEST(RobustnessReport, markdown_has_mean_deviation_and_worst_of_the_seeds_and_the_files) {
  RobustnessBenchmark benchmark = two_logs();
  benchmark.without_relations = {"hall"};
  const std::string page = robustness_report(benchmark, {7, 8}, "a machine").markdown;
  EXPECT_THAT(page, HasSubstr("| aces | scans kept | 1 of 2 | 2 | 0.3000 ± 0.1414 [0.4000] | 0.500 ± 0.000 "
                              "[0.500] | 100.0 | 1000.0 | 99.5 | – | 2.0 of 3600.0 |\n"));
  EXPECT_THAT(page, HasSubstr("| aces | `a0a0` | `b0b0` |"));
  EXPECT_THAT(page, HasSubstr("hall has no relations"));
  EXPECT_THAT(page, HasSubstr(", commit "));
}

TEST(RobustnessReport, json_names_its_origin_and_unknown_shares) {
  const Json json = Json::parse(robustness_report(two_logs(), {7, 8}, "a machine").json);
  EXPECT_EQ(json["schema"], "psi-slam-robustness");
  EXPECT_EQ(json["machine"], "a machine");
  EXPECT_EQ(json["seeds"], Json({7, 8}));
  EXPECT_NEAR(json["logs"][1]["natural_odometry_noise"]["deg_per_root_rad"].get<double>(), 2, 1e-12);
  ASSERT_EQ(json["rows"].size(), 6U);
  EXPECT_EQ(json["rows"][1]["case"], "1 of 2");
  EXPECT_EQ(json["rows"][1]["seeds"], Json({1, 8}));
  EXPECT_NEAR(json["rows"][1]["translation_error_m"]["mean"].get<double>(), 0.3, 1e-12);
  EXPECT_EQ(json["rows"][1]["translation_error_m"]["max"], 0.4);
  EXPECT_EQ(json["rows"][1]["unmatched_scans"]["mean"], 2);
  EXPECT_EQ(json["rows"][1]["loop_precision"]["mean"], 0.995) << "of the run that has one";
  EXPECT_NE(json["commit"], "");
  EXPECT_EQ(json["files"][0]["sha256"], "a0a0");
  EXPECT_TRUE(json["rows"][1]["loop_recall"].is_null());
}

TEST(RobustnessReport, csv_has_a_line_for_each_case) {
  const std::string csv = robustness_report(two_logs(), {7, 8}, "a machine").csv;
  EXPECT_THAT(csv, HasSubstr("log,series,case,seeds,translation_error_m.mean,"));
  EXPECT_THAT(csv, HasSubstr("\naces,scans kept,1 of 2,1 8,0.3"));
}

TEST(RobustnessReport, draws_a_plot_for_each_series_with_a_line_for_each_log) {
  const std::vector<BenchReport::Plot> plots = robustness_report(two_logs(), {7, 8}, "a machine").plots;
  ASSERT_EQ(plots.size(), 2U);
  EXPECT_EQ(plots[0].file, "robustness-scans-kept.svg");
  EXPECT_EQ(plots[1].file, "robustness-field-of-view.svg");
  for (const BenchReport::Plot& plot : plots) {
    EXPECT_EQ(complaint_about(plot.content), "");
    EXPECT_THAT(plot.content,
                testing::AllOf(HasSubstr(">aces<"), HasSubstr(">&lt;intel&gt;<"), HasSubstr(" m<")));
  }
  EXPECT_THAT(plots[0].content, HasSubstr(">1 of 2<"));
  EXPECT_THAT(plots[0].content, HasSubstr("class=\"spread\"")) << "two seeds";
  EXPECT_THAT(plots[1].content, testing::Not(HasSubstr("class=\"spread\""))) << "one seed";
}

}  // namespace
}  // namespace psi_slam
