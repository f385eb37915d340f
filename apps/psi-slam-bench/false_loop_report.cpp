// SPDX-License-Identifier: BSD-3-Clause
#include "false_loop_report.h"

#include <nlohmann/json.hpp>

#include "growth_plot.h"
#include "psi_slam/results/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(const std::string& text) {
  return ' ' + text + " |";
}

std::string counts(const LoopTrialOutcome& outcome) {
  return std::to_string(outcome.false_kept) + " / " + std::to_string(outcome.true_lost);
}

std::string row_text(const FalseLoopRow& row) {
  return '|' + cell(row.log) + cell(name_of(row.kind)) + cell(fixed_text(row.share_percent, 0)) +
         cell(std::to_string(row.false_loops)) + cell(fixed_text(row.undefended.error.translation_m, 3)) +
         cell(fixed_text(row.worst_first.error.translation_m, 4)) + cell(counts(row.worst_first)) +
         cell(fixed_text(row.defended.error.translation_m, 4)) +
         cell(fixed_text(row.defended.error.rotation_deg, 3)) + cell(counts(row.defended)) +
         cell(fixed_text(row.defended.milliseconds, 0)) +
         cell(fixed_text(row.from_map.error.translation_m, 4)) + cell(counts(row.from_map)) + '\n';
}

std::string logs_text(const std::vector<FalseLoopLog>& logs) {
  std::string text =
      "| log | nodes | loops | error of its map [m] | [deg] | without loops [m] | [deg] |\n"
      "|---|---:|---:|---:|---:|---:|---:|\n";
  for (const FalseLoopLog& log : logs)
    text += '|' + cell(log.name) + cell(std::to_string(log.nodes)) + cell(std::to_string(log.loops)) +
            cell(fixed_text(log.map.translation_m, 4)) + cell(fixed_text(log.map.rotation_deg, 3)) +
            cell(fixed_text(log.front_end.translation_m, 4)) +
            cell(fixed_text(log.front_end.rotation_deg, 3)) + '\n';
  return text;
}

Json error_json(const LoopTrial::Error& error) {
  return {{"translation_error_m", error.translation_m}, {"rotation_error_deg", error.rotation_deg}};
}

Json outcome_json(const LoopTrialOutcome& outcome) {
  Json json = error_json(outcome.error);
  json["false_kept"] = outcome.false_kept;
  json["true_lost"] = outcome.true_lost;
  json["time_ms"] = outcome.milliseconds;
  return json;
}

}  // namespace

std::string false_loop_markdown(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                                const std::string& machine) {
  const FalseLoopOptions how;
  std::string text = "# False loops survived\n\npsi-slam " PSI_SLAM_VERSION ", " + machine + "; seed " +
                     std::to_string(options.seed) + ". Errors are means over the true relations.\n\n";
  text +=
      "- share: false loops added to the finished graph, in percent of the loops that the run accepted\n"
      "- scattered: between random nodes and local maps, at a random place and heading within " +
      fixed_text(how.reach_m, 0) + " m of the map's anchor\n- groups: " + std::to_string(how.smallest_group) +
      " to " + std::to_string(how.largest_group) +
      " successive nodes agree with each other on such a place\n- nearby: true loops, moved by " +
      fixed_text(how.min_error_m, 0) + " to " + fixed_text(how.nearby_m, 0) + " m and turned by up to " +
      fixed_text(how.min_error_rad * 180 / M_PI, 0) +
      " degrees\n"
      "- undefended: optimised with all of them; worst first: the worst are switched off until none is "
      "contradicted; defended: as psi-slam does it. All begin at the poses before any loop was closed; "
      "\"from the map\" begins at the finished map.\n"
      "- kept / lost: false loops that stay on / true ones that are switched off\n\n";
  text += logs_text(benchmark.logs);
  text +=
      "\n| log | kind | share % | false loops | undefended [m] | worst first [m] | kept / lost | defended "
      "[m] | "
      "[deg] | kept / lost | ms | from the map [m] | kept / lost |\n|---|---|";
  for (int column = 0; column < 11; ++column) text += "---:|";
  text += '\n';
  for (const FalseLoopRow& row : benchmark.rows) text += row_text(row);
  return text;
}

std::string false_loop_json(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                            const std::string& machine) {
  Json logs = Json::array();
  for (const FalseLoopLog& log : benchmark.logs)
    logs.push_back({{"name", log.name},
                    {"nodes", log.nodes},
                    {"loops", log.loops},
                    {"map", error_json(log.map)},
                    {"without_loops", error_json(log.front_end)}});
  Json rows = Json::array();
  for (const FalseLoopRow& row : benchmark.rows)
    rows.push_back({{"log", row.log},
                    {"kind", name_of(row.kind)},
                    {"share_percent", row.share_percent},
                    {"true_loops", row.true_loops},
                    {"false_loops", row.false_loops},
                    {"undefended", outcome_json(row.undefended)},
                    {"worst_first", outcome_json(row.worst_first)},
                    {"defended", outcome_json(row.defended)},
                    {"from_map", outcome_json(row.from_map)}});
  const Json json = {{"schema", "psi-slam-false-loops"},
                     {"schema_version", 1},
                     {"program_version", PSI_SLAM_VERSION},
                     {"machine", machine},
                     {"seed", options.seed},
                     {"logs", logs},
                     {"rows", rows}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string false_loop_plot(const FalseLoopBenchmark& benchmark, FalseLoopKind kind) {
  GrowthPlot plot;
  plot.title = "Error by the share of false loops, " + name_of(kind) + " (dark: defended, light: not)";
  plot.unit = "m";
  plot.labels = {"0 %"};
  for (const FalseLoopLog& log : benchmark.logs) {
    GrowthPlot::Line defended{log.name, {log.map.translation_m}};
    GrowthPlot::Line undefended{"", {log.map.translation_m}, true};
    for (const FalseLoopRow& row : benchmark.rows) {
      if (row.log != log.name || row.kind != kind) continue;
      if (plot.lines.empty()) plot.labels.push_back(fixed_text(row.share_percent, 0) + " %");
      defended.values.push_back(row.defended.error.translation_m);
      undefended.values.push_back(row.undefended.error.translation_m);
    }
    plot.lines.push_back(std::move(defended));
    plot.lines.push_back(std::move(undefended));
  }
  return growth_svg(plot);
}

}  // namespace psi_slam
