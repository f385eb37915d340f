// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulate_report.h"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/growth_plot.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const NormalisedErrors& errors) {
  return {{"of", errors.of},
          {"count", errors.count},
          {"mean", errors.mean},
          {"median", errors.median},
          {"beyond_95", errors.beyond_95}};
}

NormalisedErrors normalised_errors_of(const Json& json) {
  return {json.at("of"), json.at("count"), json.at("mean"), json.at("median"), json.at("beyond_95")};
}

Json json_of(const SimulateRow& row) {
  Json stages = Json::object();
  for (const auto& [stage, time_s] : row.stages_s) stages[stage] = time_s;
  Json covariances = Json::array();
  for (const NormalisedErrors& errors : row.covariances) covariances.push_back(json_of(errors));
  return {{"path_m", row.path_m},
          {"scans", row.scans},
          {"rooms", row.rooms},
          {"corridors_m", row.corridors_m},
          {"nodes", row.nodes},
          {"local_maps", row.local_maps},
          {"error_mean_m", row.error_mean_m},
          {"error_max_m", row.error_max_m},
          {"relation_mean_m", row.relation_mean_m},
          {"relation_mean_deg", row.relation_mean_deg},
          {"odometry_error_mean_m", row.odometry_error_mean_m},
          {"loops", row.loops},
          {"false_loops", row.false_loops},
          {"covariances", covariances},
          {"scan_ms", {{"mean", row.scan_ms.mean}, {"p99", row.scan_ms.p99}}},
          {"add_s", row.add_s},
          {"finish_s", row.finish_s},
          {"peak_memory_mib", row.peak_memory_mib},
          {"stages_s", stages}};
}

std::string drives_text(const std::vector<SimulateRow>& rows) {
  std::string text =
      "| path | scans | corridors [m] | rooms | nodes | local maps | error mean [m] | error max [m] | "
      "relations [m] | relations [deg] | odometry [m] | loops | false |\n"
      "|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const SimulateRow& row : rows)
    text += "| " + metres_text(row.path_m) + " | " + std::to_string(row.scans) + " | " +
            fixed_text(row.corridors_m, 0) + " | " + std::to_string(row.rooms) + " | " +
            std::to_string(row.nodes) + " | " + std::to_string(row.local_maps) + " | " +
            fixed_text(row.error_mean_m, 3) + " | " + fixed_text(row.error_max_m, 3) + " | " +
            fixed_text(row.relation_mean_m, 3) + " | " + fixed_text(row.relation_mean_deg, 2) + " | " +
            fixed_text(row.odometry_error_mean_m, 1) + " | " + std::to_string(row.loops) + " | " +
            std::to_string(row.false_loops) + " |\n";
  return text;
}

std::string cost_text(const std::vector<SimulateRow>& rows) {
  std::string text =
      "| path | a scan, mean [ms] | a scan, p99 [ms] | all scans [s] | after the last [s] | "
      "memory [MiB] |";
  std::string rule = "|---:|---:|---:|---:|---:|---:|";
  if (!rows.empty())
    for (const auto& [stage, time_s] : rows.front().stages_s) {
      text += ' ' + stage + " [s] |";
      rule += "---:|";
    }
  text += '\n' + rule + '\n';
  for (const SimulateRow& row : rows) {
    text += "| " + metres_text(row.path_m) + " | " + fixed_text(row.scan_ms.mean, 2) + " | " +
            fixed_text(row.scan_ms.p99, 2) + " | " + fixed_text(row.add_s, 1) + " | " +
            fixed_text(row.finish_s, 1) + " | " + fixed_text(row.peak_memory_mib, 0) + " |";
    for (const auto& [stage, time_s] : row.stages_s) text += ' ' + fixed_text(time_s, 1) + " |";
    text += '\n';
  }
  return text;
}

std::string covariances_text(const std::vector<SimulateRow>& rows) {
  std::string text =
      "Normalised errors: squared errors over their covariances, which follow the chi-square distribution of "
      "three degrees of freedom where the covariances are right. Mean and median are given over those of "
      "that "
      "distribution, and should be 1; of all, 5 % should lie beyond its 95 % point. More is too sure, less "
      "too careful.\n\n"
      "| path | of | poses | mean | median | beyond 95 % point |\n|---:|---|---:|---:|---:|---:|\n";
  for (const SimulateRow& row : rows)
    for (const NormalisedErrors& errors : row.covariances)
      text += "| " + metres_text(row.path_m) + " | " + errors.of + " | " + std::to_string(errors.count) +
              " | " + fixed_text(errors.mean, 2) + " | " + fixed_text(errors.median, 2) + " | " +
              fixed_text(100 * errors.beyond_95, 1) + " % |\n";
  return text;
}

GrowthPlot plot_of(
    const std::vector<SimulateRow>& rows, std::string title, std::string unit,
    const std::vector<std::pair<std::string, std::function<double(const SimulateRow&)>>>& lines) {
  GrowthPlot plot;
  plot.title = std::move(title);
  plot.unit = std::move(unit);
  for (const SimulateRow& row : rows) plot.labels.push_back(metres_text(row.path_m));
  for (const auto& [name, value] : lines) {
    plot.lines.push_back({name, {}});
    for (const SimulateRow& row : rows) plot.lines.back().values.push_back(value(row));
  }
  return plot;
}

}  // namespace

std::string metres_text(double metres) {
  const double whole = std::round(metres);
  if (whole < 10000) return fixed_text(whole, 0) + " m";
  return fixed_text(metres / 1000, std::abs(std::remainder(whole, 1000)) < 50 ? 0 : 1) + " km";
}

std::string simulate_markdown(const std::vector<SimulateRow>& rows, const SimulateOptions& options,
                              const std::string& machine) {
  std::string text = "# Simulated drives of growing length\n\n";
  text += "psi-slam " PSI_SLAM_VERSION ", " + machine + ", " + std::to_string(options.threads) +
          (options.threads == 1 ? " thread" : " threads") + ", default settings; seed " +
          std::to_string(options.seed) + ", " + std::to_string(options.people) + " people for every 500 m, " +
          fixed_text(100 * options.glass_share, 0) +
          " % glass. Each drive has a building and a process of its own.\n\n";
  text +=
      "- error: distance from the truth, both paths laid on each other at the first scan\n"
      "- relations: metric of Kümmerle et al. over " +
      std::to_string(kRelations) +
      " pairs of scans drawn at random\n"
      "- odometry: mean error of odometry alone, as error\n"
      "- false: of the loops that the map keeps, those more than " +
      fixed_text(kFalseLoop_m, 1) + " m or " + fixed_text(kFalseLoop_deg, 0) +
      " degrees off the truth\n"
      "- times are the mapper's alone; making the scans is not counted\n\n";
  return text + drives_text(rows) + '\n' + cost_text(rows) + '\n' + covariances_text(rows);
}

std::string simulate_json(const std::vector<SimulateRow>& rows, const SimulateOptions& options,
                          const std::string& machine) {
  Json drives = Json::array();
  for (const SimulateRow& row : rows) drives.push_back(json_of(row));
  const Json json = {{"schema", "psi-slam-simulate-benchmark"},
                     {"schema_version", 1},
                     {"program_version", PSI_SLAM_VERSION},
                     {"machine", machine},
                     {"seed", options.seed},
                     {"people_per_500_m", options.people},
                     {"glass_share", options.glass_share},
                     {"threads", options.threads},
                     {"drives", drives}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string row_json_text(const SimulateRow& row) {
  return json_of(row).dump();
}

SimulateRow row_of_json(const std::string& text) {
  const Json json = Json::parse(text);
  SimulateRow row;
  json.at("path_m").get_to(row.path_m);
  json.at("scans").get_to(row.scans);
  json.at("rooms").get_to(row.rooms);
  json.at("corridors_m").get_to(row.corridors_m);
  json.at("nodes").get_to(row.nodes);
  json.at("local_maps").get_to(row.local_maps);
  json.at("error_mean_m").get_to(row.error_mean_m);
  json.at("error_max_m").get_to(row.error_max_m);
  json.at("relation_mean_m").get_to(row.relation_mean_m);
  json.at("relation_mean_deg").get_to(row.relation_mean_deg);
  json.at("odometry_error_mean_m").get_to(row.odometry_error_mean_m);
  json.at("loops").get_to(row.loops);
  json.at("false_loops").get_to(row.false_loops);
  for (const Json& errors : json.at("covariances")) row.covariances.push_back(normalised_errors_of(errors));
  json.at("scan_ms").at("mean").get_to(row.scan_ms.mean);
  json.at("scan_ms").at("p99").get_to(row.scan_ms.p99);
  json.at("add_s").get_to(row.add_s);
  json.at("finish_s").get_to(row.finish_s);
  json.at("peak_memory_mib").get_to(row.peak_memory_mib);
  for (const auto& [stage, time_s] : json.at("stages_s").items())
    row.stages_s.emplace_back(stage, time_s.get<double>());
  return row;
}

std::string error_plot(const std::vector<SimulateRow>& rows) {
  return growth_svg(plot_of(rows, "Error by the length of the path", "m",
                            {{"odometry", [](const SimulateRow& row) { return row.odometry_error_mean_m; }},
                             {"largest", [](const SimulateRow& row) { return row.error_max_m; }},
                             {"mean", [](const SimulateRow& row) { return row.error_mean_m; }},
                             {"relations", [](const SimulateRow& row) { return row.relation_mean_m; }}}));
}

std::string time_plot(const std::vector<SimulateRow>& rows) {
  const auto whole = [](const SimulateRow& row) {
    return 1e3 * (row.add_s + row.finish_s) / static_cast<double>(row.scans);
  };
  return growth_svg(plot_of(rows, "Time of a scan by the length of the path", "ms",
                            {{"p99", [](const SimulateRow& row) { return row.scan_ms.p99; }},
                             {"mean", [](const SimulateRow& row) { return row.scan_ms.mean; }},
                             {"mean, all work", whole}}));
}

std::string memory_plot(const std::vector<SimulateRow>& rows) {
  return growth_svg(plot_of(rows, "Peak memory by the length of the path", "MiB",
                            {{"memory", [](const SimulateRow& row) { return row.peak_memory_mib; }}}));
}

}  // namespace psi_slam
