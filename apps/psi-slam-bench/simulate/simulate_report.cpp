// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulate_benchmark.h"

#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "common/log_plots.h"
#include "map/report/html_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<SimulateRow>;
using Column = ColumnOf<SimulateRow>;

Column path_column() {
  return {{"path", "path_m"}, [](const SimulateRow& row) {
            return ReportCell{metres_text(row.path_m), row.path_m};
          }};
}

std::vector<Column> map_columns() {
  return {path_column(),
          column("scans", "scans", &SimulateRow::scans),
          column("corridors [m]", "corridors_m", &SimulateRow::corridors_m, 0),
          column("rooms", "rooms", &SimulateRow::rooms),
          column("nodes", "nodes", &SimulateRow::nodes),
          column("local maps", "local_maps", &SimulateRow::local_maps),
          column("error mean [m]", "error_mean_m", &SimulateRow::error_mean_m, 3),
          column("error max [m]", "error_max_m", &SimulateRow::error_max_m, 3),
          column("aligned [m]", "aligned_mean_m", &SimulateRow::aligned_mean_m, 3),
          column("relations [m]", "relation_mean_m", &SimulateRow::relation_mean_m, 3),
          column("relations [deg]", "relation_mean_deg", &SimulateRow::relation_mean_deg, 2),
          column("odometry [m]", "odometry_error_mean_m", &SimulateRow::odometry_error_mean_m, 1),
          column("loops", "loops", &SimulateRow::loops),
          column("false", "false_loops", &SimulateRow::false_loops)};
}

std::vector<Column> cost_columns() {
  return {{{"per scan, mean [ms]", "scan_ms.mean"},
           [](const SimulateRow& row) { return cell(row.scan_ms.mean, 2); }},
          {{"per scan, p99 [ms]", "scan_ms.p99"},
           [](const SimulateRow& row) { return cell(row.scan_ms.p99, 2); }},
          {{"per scan, max [ms]", "scan_ms.max"},
           [](const SimulateRow& row) { return cell(row.scan_ms.max, 1); }},
          {{"optimisation, mean [ms]", "optimisation_ms.mean"},
           [](const SimulateRow& row) { return cell(row.optimisation_ms.mean, 2); }},
          {{"optimisation, p99 [ms]", "optimisation_ms.p99"},
           [](const SimulateRow& row) { return cell(row.optimisation_ms.p99, 1); }},
          {{"optimisation, max [ms]", "optimisation_ms.max"},
           [](const SimulateRow& row) { return cell(row.optimisation_ms.max, 1); }},
          column("all scans [s]", "add_s", &SimulateRow::add_s, 1),
          column("after the last scan [s]", "finish_s", &SimulateRow::finish_s, 1),
          column("memory [MiB]", "peak_memory_mib", &SimulateRow::peak_memory_mib, 0)};
}

ReportTable cost_table(const Rows& rows) {
  std::vector<Column> columns{path_column()};
  for (const Column& column : cost_columns()) columns.push_back(column);
  if (!rows.empty())
    for (std::size_t i = 0; i < rows.front().stages_s.size(); ++i)
      columns.push_back({{rows.front().stages_s[i].first + " [s]"},
                         [i](const SimulateRow& row) { return cell(row.stages_s.at(i).second, 1); }});
  return table_of(columns, rows);
}

/// Normalised errors of one kind of poses in one run.
struct CovarianceRow {
  double path_m;
  NormalisedErrors errors;
};

ReportTable covariances_table(const Rows& rows) {
  std::vector<CovarianceRow> covariances;
  for (const SimulateRow& row : rows)
    for (const NormalisedErrors& errors : row.covariances) covariances.push_back({row.path_m, errors});
  using Row = CovarianceRow;
  return table_of<Row>(
      {{{"path"}, [](const Row& row) { return cell(metres_text(row.path_m)); }},
       {{"of", "of", true}, [](const Row& row) { return cell(row.errors.of); }},
       {{"poses", "count"}, [](const Row& row) { return cell(row.errors.count); }},
       {{"mean", "mean"}, [](const Row& row) { return cell(row.errors.mean, 2); }},
       {{"median", "median"}, [](const Row& row) { return cell(row.errors.median, 2); }},
       {{"beyond 95 % point", "beyond_95"},
        [](const Row& row) {
          return ReportCell{fixed_text(100 * row.errors.beyond_95, 1) + " %", row.errors.beyond_95};
        }}},
      covariances);
}

/// All figures, for JSON and CSV.
ReportTable figures_table(const Rows& rows) {
  std::vector<Column> columns = map_columns();
  columns.push_back({{{}, "covariances"}, [](const SimulateRow& row) {
                       return ReportCell{{}, covariances_table({row}).json()};
                     }});
  for (const Column& column : cost_columns()) columns.push_back(column);
  columns.push_back({{{}, "stages_s"}, [](const SimulateRow& row) {
                       Json stages = Json::object();
                       for (const auto& [stage, time_s] : row.stages_s) stages[stage] = time_s;
                       return ReportCell{{}, stages};
                     }});
  return table_of(columns, rows);
}

std::string markdown_of(const Rows& rows, const SimulateOptions& options, const std::string& machine) {
  std::string text =
      "# Simulated runs of growing length\n\n" + measured_by(machine) + ", " +
      counted(static_cast<std::size_t>(options.threads), "thread", "threads") + ", default settings; seed " +
      std::to_string(options.seed) + ", " + std::to_string(options.people) + " people for every 500 m, " +
      fixed_text(100 * options.glass_share, 0) + " % glass, laser with a range of " +
      fixed_text(options.max_range_m, 0) + " m and a noise of " + fixed_text(options.range_noise_m, 3) +
      " m. Each run has a building and a process of its own.\n\n";
  text +=
      "- error: distance from the truth, with both paths aligned at the first scan\n"
      "- aligned: mean distance from the truth after the best rigid alignment\n"
      "- relations: metric of Kümmerle et al. over " +
      std::to_string(kRelations) +
      " randomly drawn pairs of scans\n- odometry: mean error of odometry alone, measured like error\n"
      "- false: loops kept by the map that are more than " +
      fixed_text(kFalseLoop_m, 1) + " m or " + fixed_text(kFalseLoop_deg, 0) +
      " degrees off the truth\n- times are the mapper's alone; making the scans is not counted\n"
      "\n";
  return text + table_of(map_columns(), rows).markdown() + '\n' + cost_table(rows).markdown() +
         "\nNormalised errors are squared errors divided by their covariances. With correct covariances they "
         "follow the chi-square distribution with three degrees of freedom. Mean and median are divided by "
         "those of this distribution and should be 1; 5 % of the errors should lie beyond its 95 % point. "
         "Larger values mean that the covariances are too small, smaller values that they are too "
         "large.\n\n" +
         covariances_table(rows).markdown();
}

/// SVG plot over the length of the path. Each element of `lines` has the name of a line and the function that
/// gives its value for a run.
std::string growth_over_path(
    const Rows& rows, const std::string& title, const std::string& unit,
    const std::vector<std::pair<std::string, std::function<double(const SimulateRow&)>>>& lines) {
  GrowthPlot plot{title, unit, {}, {}};
  for (const SimulateRow& row : rows) plot.labels.push_back(metres_text(row.path_m));
  for (const auto& [name, value] : lines) {
    plot.lines.push_back({name, {}});
    for (const SimulateRow& row : rows) plot.lines.back().values.push_back(spread_of({value(row)}));
  }
  return growth_svg(plot);
}

double time_per_scan_ms(const SimulateRow& row) {
  return 1e3 * (row.add_s + row.finish_s) / static_cast<double>(row.scans);
}

std::vector<BenchReport::Plot> plots_of(const Rows& rows) {
  using Row = SimulateRow;
  return {{"simulate-error.svg",
           growth_over_path(rows, "Error over the length of the path", "m",
                            {{"odometry", [](const Row& row) { return row.odometry_error_mean_m; }},
                             {"largest", [](const Row& row) { return row.error_max_m; }},
                             {"mean", [](const Row& row) { return row.error_mean_m; }},
                             {"relations", [](const Row& row) { return row.relation_mean_m; }}})},
          {"simulate-time.svg", growth_over_path(rows, "Time per scan over the length of the path", "ms",
                                                 {{"p99", [](const Row& row) { return row.scan_ms.p99; }},
                                                  {"mean", [](const Row& row) { return row.scan_ms.mean; }},
                                                  {"mean, all work", time_per_scan_ms}})},
          {"simulate-memory.svg",
           growth_over_path(rows, "Peak memory over the length of the path", "MiB",
                            {{"memory", [](const Row& row) { return row.peak_memory_mib; }}})}};
}

}  // namespace

std::string metres_text(double metres) {
  const double whole = std::round(metres);
  if (whole < 10000) return fixed_text(whole, 0) + " m";
  return fixed_text(metres / 1000, std::abs(std::remainder(whole, 1000)) < 50 ? 0 : 1) + " km";
}

BenchReport simulate_report(const Rows& rows, const SimulateOptions& options, const std::string& machine) {
  const ReportTable figures = figures_table(rows);
  return {"simulate.md", markdown_of(rows, options, machine),
          json_file_text(report_json("psi-slam-simulate-benchmark", machine,
                                     {{"seed", options.seed},
                                      {"people_per_500_m", options.people},
                                      {"glass_share", options.glass_share},
                                      {"max_range_m", options.max_range_m},
                                      {"range_noise_m", options.range_noise_m},
                                      {"threads", options.threads},
                                      {"drives", figures.json()}})),
          figures.csv(), plots_of(rows)};
}

}  // namespace psi_slam
