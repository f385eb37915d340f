// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/robustness_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/growth_plot.h"
#include "common/program_identity.h"
#include "batch/seed_spread.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / M_PI;

/// The rows of a case on a log, one a seed.
using Runs = std::vector<RobustnessRow>;

std::vector<Runs> cases_of(const RobustnessBenchmark& benchmark) {
  return by_case(benchmark.rows, [](const RobustnessRow& a, const RobustnessRow& b) {
    return a.log == b.log && a.degraded.series == b.degraded.series && a.degraded.name == b.degraded.name;
  });
}

/// Of the runs that have one; none when no run has.
SeedSpread spread_of_known(const Runs& runs, std::optional<double> RobustnessRow::*share) {
  std::vector<double> known;
  for (const RobustnessRow& run : runs)
    if (run.*share) known.push_back(*(run.*share));
  return spread_of(known);
}

std::string percent(const SeedSpread& share) {
  return share.count > 0 ? fixed_text(100 * share.mean, 1) : "–";
}

Json json_or_null(const SeedSpread& share) {
  return share.count > 0 ? spread_json(share) : Json(nullptr);
}

template <class Figure>
SeedSpread over_seeds(const Runs& runs, Figure RobustnessRow::*figure) {
  return spread_over(runs, [figure](const RobustnessRow& run) { return run.*figure; });
}

/// The mean, without decimals where there is one run.
std::string count_text(const SeedSpread& counts) {
  return fixed_text(counts.mean, counts.count > 1 ? 1 : 0);
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

std::string row_text(const Runs& runs) {
  const RobustnessRow& first = runs.front();
  return "| " + first.log + " | " + first.degraded.series + " | " + first.degraded.name + " | " +
         std::to_string(runs.size()) + " | " +
         spread_text(over_seeds(runs, &RobustnessRow::translation_error_m), 4) + " | " +
         spread_text(over_seeds(runs, &RobustnessRow::rotation_error_deg), 3) + " | " +
         count_text(over_seeds(runs, &RobustnessRow::relations)) + " | " +
         count_text(over_seeds(runs, &RobustnessRow::loops)) + " | " +
         percent(spread_of_known(runs, &RobustnessRow::loop_precision)) + " | " +
         percent(spread_of_known(runs, &RobustnessRow::loop_recall)) + " | " +
         count_text(over_seeds(runs, &RobustnessRow::unmatched)) + " of " +
         count_text(over_seeds(runs, &RobustnessRow::scans)) + " |\n";
}

Json row_json(const Runs& runs) {
  const RobustnessRow& first = runs.front();
  return {{"log", first.log},
          {"series", first.degraded.series},
          {"case", first.degraded.name},
          {"seeds", seeds_of(runs)},
          {"translation_error_m", spread_json(over_seeds(runs, &RobustnessRow::translation_error_m))},
          {"rotation_error_deg", spread_json(over_seeds(runs, &RobustnessRow::rotation_error_deg))},
          {"relations", spread_json(over_seeds(runs, &RobustnessRow::relations))},
          {"scans", spread_json(over_seeds(runs, &RobustnessRow::scans))},
          {"unmatched_scans", spread_json(over_seeds(runs, &RobustnessRow::unmatched))},
          {"loops", spread_json(over_seeds(runs, &RobustnessRow::loops))},
          {"loop_precision", json_or_null(spread_of_known(runs, &RobustnessRow::loop_precision))},
          {"loop_recall", json_or_null(spread_of_known(runs, &RobustnessRow::loop_recall))}};
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

std::string robustness_markdown(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                                const std::string& machine) {
  std::string text = "# Logs made worse\n\n" + measured_by(machine) + "; " + seeds_text(seeds) +
                     " of the noise. Errors are means over the true relations.\n\n";
  text +=
      "- odometry noise × k: to each step of odometry normal noise of √(k² - 1) times its natural noise is "
      "added, so that its error is about k times what it was. The natural noise is odometry's error against "
      "the map of the log as it is, over stretches of 1 m or 1 rad, as a random walk: its variance grows "
      "with the way and the turn.\n"
      "- no odometry: the robot is predicted to go on at its speed\n"
      "- scans kept: the others are not there at all; relations of their times are answered by "
      "interpolation, "
      "whose errors count\n"
      "- field of view: beams beside it are no returns\n"
      "- precision, recall: of the accepted loops, by the true relations\n"
      "- unmatched: scans that the front end could not match with its local map\n"
      "- runs: one for each seed where the case draws random numbers, else one; of several, errors are mean "
      "± standard deviation of the sample [worst], the other figures means\n\n";
  text += logs_text(benchmark.logs);
  text +=
      "\n| log | | | runs | error [m] | [deg] | relations | loops | precision % | recall % | unmatched |\n"
      "|---|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const Runs& runs : cases_of(benchmark)) text += row_text(runs);
  return text + '\n' + logs_markdown(benchmark.identities, benchmark.without_relations);
}

std::string robustness_json(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                            const std::string& machine) {
  Json logs = Json::array();
  for (const RobustnessLog& log : benchmark.logs)
    logs.push_back({{"name", log.name},
                    {"natural_odometry_noise",
                     {{"m_per_root_m", log.natural.sigma_m_per_root_m},
                      {"deg_per_root_m", kDegrees * log.natural.sigma_rad_per_root_m},
                      {"deg_per_root_rad", kDegrees * log.natural.sigma_rad_per_root_rad}}}});
  Json files = Json::array();
  for (const LogIdentity& log : benchmark.identities) files.push_back(log_json(log));
  Json rows = Json::array();
  for (const Runs& runs : cases_of(benchmark)) rows.push_back(row_json(runs));
  const Json json = {{"schema", "psi-slam-robustness"},
                     {"schema_version", 1},
                     {"program_version", program_version()},
                     {"commit", program_commit()},
                     {"machine", machine},
                     {"seeds", seeds.all()},
                     {"files", files},
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
      GrowthPlot::Line line;
      line.name = log.name;
      for (const Runs& runs : cases_of(benchmark)) {
        const RobustnessRow& first = runs.front();
        if (first.log != log.name || first.degraded.series != series) continue;
        if (plot.lines.empty()) plot.labels.push_back(first.degraded.name);
        const SeedSpread errors = over_seeds(runs, &RobustnessRow::translation_error_m);
        line.values.push_back(errors.mean);
        line.low.push_back(errors.min);
        line.high.push_back(errors.max);
      }
      plot.lines.push_back(std::move(line));
    }
    plots.push_back({series, file_of(series), growth_svg(plot)});
  }
  return plots;
}

}  // namespace psi_slam
