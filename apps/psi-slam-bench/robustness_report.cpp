// SPDX-License-Identifier: BSD-3-Clause
#include "robustness_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "growth_plot.h"
#include "psi_slam/results/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / M_PI;

std::string percent(const std::optional<double>& share) {
  return share ? fixed_text(100 * *share, 1) : "–";
}

Json number_or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::string logs_text(const std::vector<RobustnessLog>& logs) {
  std::string text =
      "| log | odometry's natural noise [m / √m] | [deg / √m] | [deg / √rad] |\n|---|---:|---:|---:|\n";
  for (const RobustnessLog& log : logs)
    text += "| " + log.name + " | " + fixed_text(log.natural.sigma_m_per_root_m, 4) + " | " +
            fixed_text(kDegrees * log.natural.sigma_rad_per_root_m, 3) + " | " +
            fixed_text(kDegrees * log.natural.sigma_rad_per_root_rad, 3) + " |\n";
  return text;
}

std::string row_text(const RobustnessRow& row) {
  return "| " + row.log + " | " + row.degraded.series + " | " + row.degraded.name + " | " +
         fixed_text(row.translation_error_m, 4) + " | " + fixed_text(row.rotation_error_deg, 3) + " | " +
         std::to_string(row.relations) + " | " + std::to_string(row.loops) + " | " +
         percent(row.loop_precision) + " | " + percent(row.loop_recall) + " | " +
         std::to_string(row.unmatched) + " of " + std::to_string(row.scans) + " |\n";
}

/// The series of the rows, each once, in their order.
std::vector<std::string> series_of(const RobustnessBenchmark& benchmark) {
  std::vector<std::string> series;
  for (const RobustnessRow& row : benchmark.rows)
    if (std::find(series.begin(), series.end(), row.degraded.series) == series.end())
      series.push_back(row.degraded.series);
  return series;
}

std::string file_of(std::string series) {
  std::replace(series.begin(), series.end(), ' ', '-');
  return "robustness-" + series + ".svg";
}

}  // namespace

std::string robustness_markdown(const RobustnessBenchmark& benchmark, std::uint64_t seed,
                                const std::string& machine) {
  std::string text = "# Logs made worse\n\npsi-slam " PSI_SLAM_VERSION ", " + machine + "; seed " +
                     std::to_string(seed) + ". Errors are means over the true relations.\n\n";
  text +=
      "- odometry noise × k: to each step of odometry normal noise of √(k² - 1) times its natural noise is "
      "added, so that its error is about k times what it was. The natural noise is odometry's error against "
      "the map of the log as it is, over stretches of 1 m or 1 rad, as a random walk: its variance grows "
      "with "
      "the way and the turn.\n"
      "- no odometry: the robot is predicted to go on at its speed\n"
      "- scans kept: the others are not there at all; relations of their times are answered by "
      "interpolation, "
      "whose errors count\n"
      "- field of view: beams beside it are no returns\n"
      "- precision, recall: of the accepted loops, by the true relations\n"
      "- unmatched: scans that the front end could not match with its local map\n\n";
  text += logs_text(benchmark.logs);
  text +=
      "\n| log | | | error [m] | [deg] | relations | loops | precision % | recall % | unmatched |\n"
      "|---|---|---|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const RobustnessRow& row : benchmark.rows) text += row_text(row);
  return text;
}

std::string robustness_json(const RobustnessBenchmark& benchmark, std::uint64_t seed,
                            const std::string& machine) {
  Json logs = Json::array();
  for (const RobustnessLog& log : benchmark.logs)
    logs.push_back({{"name", log.name},
                    {"natural_odometry_noise",
                     {{"m_per_root_m", log.natural.sigma_m_per_root_m},
                      {"deg_per_root_m", kDegrees * log.natural.sigma_rad_per_root_m},
                      {"deg_per_root_rad", kDegrees * log.natural.sigma_rad_per_root_rad}}}});
  Json rows = Json::array();
  for (const RobustnessRow& row : benchmark.rows)
    rows.push_back({{"log", row.log},
                    {"series", row.degraded.series},
                    {"case", row.degraded.name},
                    {"translation_error_m", row.translation_error_m},
                    {"rotation_error_deg", row.rotation_error_deg},
                    {"relations", row.relations},
                    {"scans", row.scans},
                    {"unmatched_scans", row.unmatched},
                    {"loops", row.loops},
                    {"loop_precision", number_or_null(row.loop_precision)},
                    {"loop_recall", number_or_null(row.loop_recall)}});
  const Json json = {{"schema", "psi-slam-robustness"},
                     {"schema_version", 1},
                     {"program_version", PSI_SLAM_VERSION},
                     {"machine", machine},
                     {"seed", seed},
                     {"logs", logs},
                     {"rows", rows}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::vector<RobustnessPlot> robustness_plots(const RobustnessBenchmark& benchmark) {
  std::vector<RobustnessPlot> plots;
  for (const std::string& series : series_of(benchmark)) {
    GrowthPlot plot;
    plot.title = "Error by " + series;
    plot.unit = "m";
    for (const RobustnessLog& log : benchmark.logs) {
      GrowthPlot::Line line{log.name, {}};
      for (const RobustnessRow& row : benchmark.rows) {
        if (row.log != log.name || row.degraded.series != series) continue;
        if (plot.lines.empty()) plot.labels.push_back(row.degraded.name);
        line.values.push_back(row.translation_error_m);
      }
      plot.lines.push_back(std::move(line));
    }
    plots.push_back({series, file_of(series), growth_svg(plot)});
  }
  return plots;
}

}  // namespace psi_slam
