// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulate_benchmark.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace psi_slam {
namespace {

using testing::HasSubstr;
using OrderedJson = nlohmann::ordered_json;

SimulateRow row() {
  SimulateRow row;
  row.path_m = 1000.06;
  row.scans = 10001;
  row.rooms = 36;
  row.corridors_m = 334.5;
  row.nodes = 2464;
  row.local_maps = 83;
  row.error_mean_m = 1.0 / 3;
  row.error_max_m = 0.7;
  row.aligned_mean_m = 0.21;
  row.relation_mean_m = 0.12;
  row.relation_mean_deg = 0.5;
  row.odometry_error_mean_m = 12.3;
  row.loops = 700;
  row.false_loops = 2;
  row.covariances = {{"loops", 700, 1.5, 0.9, 0.072}};
  row.scan_ms = {0.99, 8.42, 9.5};
  row.optimisation_ms = {1.25, 4.5, 6.5};
  row.add_s = 9.9;
  row.finish_s = 5.5;
  row.peak_memory_mib = 210;
  row.stages_s = {{"match", 2.5}, {"close loops", 1.25}};
  return row;
}

TEST(SimulateReport, rows_survive_as_text) {
  EXPECT_EQ(row_text(row_of_text(row_text(row()))), row_text(row()));
  EXPECT_EQ(row_of_text(row_text(row())).error_mean_m, 1.0 / 3);
  EXPECT_EQ(row_of_text(row_text(row())).stages_s, row().stages_s);
}

TEST(SimulateReport, json_has_machine_seed_and_figures) {
  SimulateOptions options;
  options.seed = 77;
  const OrderedJson json = OrderedJson::parse(simulate_report({row()}, options, "a machine").json);
  EXPECT_EQ(json["machine"], "a machine");
  EXPECT_EQ(json["seed"], 77);
  EXPECT_EQ(json["drives"][0]["scan_ms"]["p99"], 8.42);
  EXPECT_EQ(json["drives"][0]["optimisation_ms"]["max"], 6.5);
  EXPECT_EQ(json["drives"][0]["stages_s"]["close loops"], 1.25);
  EXPECT_EQ(json["drives"][0]["covariances"][0]["of"], "loops");
}

TEST(SimulateReport, markdown_has_the_figures) {
  const std::string page = simulate_report({row()}, {}, "a machine").markdown;
  EXPECT_THAT(page, HasSubstr("| 1000 m | 10001 | 334 | 36 | 2464 | 83 | 0.333 | 0.700 | 0.210 | 0.120 | "
                              "0.50 | 12.3 | 700 | 2 |"));
  EXPECT_THAT(page, HasSubstr("| 1000 m | loops | 700 | 1.50 | 0.90 | 7.2 % |"));
  EXPECT_THAT(page,
              HasSubstr("| 1000 m | 0.99 | 8.42 | 9.5 | 1.25 | 4.5 | 6.5 | 9.9 | 5.5 | 210 | 2.5 | 1.2 |"));
}

TEST(SimulateReport, plots_have_their_unit) {
  const std::vector<BenchReport::Plot> plots = simulate_report({row()}, {}, "a machine").plots;
  EXPECT_THAT(plots.at(0).content, HasSubstr("0.1 m<"));
  EXPECT_THAT(plots.at(1).content, HasSubstr("1 ms<"));
  EXPECT_THAT(plots.at(2).content, HasSubstr("100 MiB<"));
}

TEST(SimulateReport, lengths_are_text) {
  EXPECT_EQ(metres_text(500.04), "500 m");
  EXPECT_EQ(metres_text(10000.06), "10 km");
  EXPECT_EQ(metres_text(12500), "12.5 km");
}

}  // namespace
}  // namespace psi_slam
