// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "sparse/sparse_benchmark.h"
#include "well_formed.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

SparseRow row(const std::string& log, const std::string& kept, std::uint64_t seed, double error_m) {
  SparseRow row;
  row.log = log;
  row.kept = kept;
  row.seed = seed;
  row.figures.errors.translation_abs_m = {error_m, 0.02};
  row.figures.errors.rotation_abs_deg = {0.5, 0.25};
  row.figures.scans = 419;
  row.figures.cpu_s = 1.25;
  row.unmatched = 2;
  row.loops = 1003;
  row.costs = {5.5, 29.2, 42.6, 6.4, 13.1};
  return row;
}

SparseBenchmark sparse_benchmark() {
  SparseBenchmark benchmark;
  benchmark.identities.push_back({"office", "a0a0", "b0b0"});
  benchmark.rows = {row("office", "1 m / 0.5 rad", 7, 0.04), row("office", "1 m / 0.5 rad", 8, 0.06),
                    row("yard", "all", 7, 0.1)};
  for (std::size_t i : {0U, 1U}) benchmark.rows[i].floor_m = 0.03;
  benchmark.rows[2].costs.time_ratio.reset();
  benchmark.rows[2].costs.evaluations_ratio.reset();
  benchmark.pictures.push_back({"yard", "the picture"});
  for (const double spacing_deg : {0.25, 2.0})
    for (const double step_m : {0.05, 1.0}) {
      SensorSweepRow sensor;
      sensor.max_range_m = 30;
      sensor.spacing_deg = spacing_deg;
      sensor.step_m = step_m;
      sensor.path_m = 232;
      sensor.scans = 250;
      sensor.error_m = 0.02 * spacing_deg;
      benchmark.sensors.push_back(sensor);
    }
  return benchmark;
}

BenchReport report() {
  SparseOptions options;
  options.seeds = {7, 8};
  return sparse_report(sparse_benchmark(), options, "a machine");
}

TEST(SparseReport, markdown_has_means_over_the_seeds) {
  const std::string page = report().markdown;
  EXPECT_THAT(page, HasSubstr("a machine; seeds 7 to 8, default settings."));
  EXPECT_THAT(page, HasSubstr("| office | 1 m / 0.5 rad | 419 | 0.0500 ± 0.0200 | 0.0300 | 0.5000 ± 0.2500 | "
                              "2 | 1003 | 1.2 | 5.5 | 29.2 | 42.6 | 6.4 | 13.1 |\n"));
  EXPECT_THAT(page, HasSubstr("| yard | all | 419 | 0.1000 ± 0.0200 | – |"));
  EXPECT_THAT(page, HasSubstr("| 42.6 | – | – |\n")) << "no node tried loops";
  EXPECT_THAT(page, HasSubstr("| 30 | 0.25 | 0.05 | 232 | 250 | 0.0050 | 0.000 | 0 | 0 | 0 |\n"));
  EXPECT_THAT(page, HasSubstr("| office | `a0a0` | `b0b0` |"));
}

TEST(SparseReport, names_changed_settings) {
  SparseOptions options;
  options.assignments = {"map.max_range_m=80"};
  EXPECT_THAT(sparse_report(sparse_benchmark(), options, "a machine").markdown,
              HasSubstr("default settings except `map.max_range_m=80`."));
}

TEST(SparseReport, leaves_out_sections_without_figures) {
  const std::string page = sparse_report({}, {}, "a machine").markdown;
  for (const char* section : {"## Real logs", "## Maps", "## Simulated", "## Logs"})
    EXPECT_THAT(page, Not(HasSubstr(section)));
}

TEST(SparseReport, json_has_the_spread_over_the_seeds) {
  const Json json = Json::parse(report().json);
  EXPECT_EQ(json["schema"], "psi-slam-sparse-benchmark");
  EXPECT_EQ(json["seeds"], Json({7, 8}));
  ASSERT_EQ(json["rows"].size(), 2U);
  const Json& office = json["rows"][0];
  EXPECT_NEAR(office["translation_abs_m"]["mean"].get<double>(), 0.05, 1e-12);
  EXPECT_EQ(office["translation_abs_m"]["over_seeds"]["max"], 0.06);
  EXPECT_EQ(office["node_ms"]["max"]["mean"], 42.6);
  EXPECT_EQ(office["floor_m"], 0.03);
  EXPECT_TRUE(json["rows"][1]["floor_m"].is_null());
  EXPECT_TRUE(json["rows"][1]["max_over_median"]["time"].is_null());
  EXPECT_EQ(json["sensors"][1]["step_m"], 1.0);
}

TEST(SparseReport, csv_has_a_line_for_each_case) {
  const std::string csv = report().csv;
  EXPECT_EQ(csv.rfind("log,kept,seeds,", 0), 0U);
  EXPECT_THAT(csv, HasSubstr("\noffice,1 m / 0.5 rad,7 8,419"));
}

TEST(SparseReport, page_shows_every_picture_and_plot) {
  const BenchReport all = report();
  ASSERT_EQ(all.plots.size(), 2U);
  EXPECT_EQ(all.plots[0].file, "sparse-yard.png");
  EXPECT_EQ(all.plots[0].content, "the picture");
  EXPECT_EQ(all.plots[1].file, "sparse-range-30m.svg");
  EXPECT_EQ(complaint_about(all.plots[1].content), "");
  EXPECT_THAT(all.plots[1].content, testing::AllOf(HasSubstr(">0.25 degrees<"), HasSubstr(">2 degrees<"),
                                                   HasSubstr(">0.05 m<"), HasSubstr(">1 m<")));
  for (const BenchReport::Plot& plot : all.plots)
    EXPECT_THAT(all.markdown, HasSubstr("](" + plot.file + ")"));
}

}  // namespace
}  // namespace psi_slam
