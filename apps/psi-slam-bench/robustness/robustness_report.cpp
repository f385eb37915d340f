// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/robustness_benchmark.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "common/log_plots.h"

namespace psi_slam {
namespace {

constexpr double kDegrees = 180 / M_PI;

/// Runs of one case on one log, with different seeds.
using Runs = std::vector<RobustnessRow>;

std::vector<Runs> cases_of(const RobustnessBenchmark& benchmark) {
  return by_case(benchmark.rows, [](const RobustnessRow& a, const RobustnessRow& b) {
    return a.log == b.log && a.degraded.series == b.degraded.series && a.degraded.name == b.degraded.name;
  });
}

template <class Figure>
SeedSpread over_seeds(const Runs& runs, Figure RobustnessRow::*figure) {
  return spread_over(runs, [figure](const RobustnessRow& run) { return run.*figure; });
}

/// Statistics over the runs that have the share: the mean in percent in Markdown, all as fractions in JSON.
ReportCell percent(const Runs& runs, std::optional<double> RobustnessRow::*share) {
  std::vector<double> known;
  for (const RobustnessRow& run : runs)
    if (run.*share) known.push_back(*(run.*share));
  const SeedSpread spread = spread_of(known);
  return {spread.count > 0 ? fixed_text(100 * spread.mean, 1) : "–", spread_json(spread)};
}

/// Mean of a count, without decimals for a single run.
ReportCell mean_count(const Runs& runs, std::size_t RobustnessRow::*figure) {
  const SeedSpread counts = over_seeds(runs, figure);
  return {fixed_text(counts.mean, counts.count > 1 ? 1 : 0), spread_json(counts)};
}

ReportTable noise_table(const std::vector<RobustnessLog>& logs) {
  using Log = RobustnessLog;
  return table_of<Log>(
      {column("log", "name", &Log::name),
       {{"natural noise of odometry [m / √m]", "natural_odometry_noise.m_per_root_m"},
        [](const Log& log) { return cell(log.natural.sigma_m_per_root_m, 4); }},
       {{"[deg / √m]", "natural_odometry_noise.deg_per_root_m"},
        [](const Log& log) { return cell(kDegrees * log.natural.sigma_rad_per_root_m, 3); }},
       {{"[deg / √rad]", "natural_odometry_noise.deg_per_root_rad"},
        [](const Log& log) { return cell(kDegrees * log.natural.sigma_rad_per_root_rad, 3); }}},
      logs);
}

ReportTable cases_table(const RobustnessBenchmark& benchmark) {
  using Row = RobustnessRow;
  const auto error = [](const std::string& head, const std::string& key, double Row::*figure, int decimals) {
    return ColumnOf<Runs>{{head, key},
                          [=](const Runs& runs) { return cell(over_seeds(runs, figure), decimals); }};
  };
  const auto count = [](const std::string& head, const std::string& key, std::size_t Row::*figure) {
    return ColumnOf<Runs>{{head, key}, [=](const Runs& runs) { return mean_count(runs, figure); }};
  };
  const auto share = [](const std::string& head, const std::string& key, std::optional<double> Row::*figure) {
    return ColumnOf<Runs>{{head, key}, [=](const Runs& runs) { return percent(runs, figure); }};
  };
  return table_of<Runs>(
      {{{"log", "log", true}, [](const Runs& runs) { return cell(runs.front().log); }},
       {{"series", "series", true}, [](const Runs& runs) { return cell(runs.front().degraded.series); }},
       {{"case", "case", true}, [](const Runs& runs) { return cell(runs.front().degraded.name); }},
       {{"runs", "seeds"},
        [](const Runs& runs) {
          return ReportCell{std::to_string(runs.size()), seeds_of(runs)};
        }},
       error("error [m]", "translation_error_m", &Row::translation_error_m, 4),
       error("[deg]", "rotation_error_deg", &Row::rotation_error_deg, 3),
       count("relations", "relations", &Row::relations),
       count("loops", "loops", &Row::loops),
       share("precision %", "loop_precision", &Row::loop_precision),
       share("recall %", "loop_recall", &Row::loop_recall),
       {{"unmatched", {}},
        [](const Runs& runs) {
          return cell(mean_count(runs, &Row::unmatched).text + " of " + mean_count(runs, &Row::scans).text);
        }},
       count({}, "unmatched_scans", &Row::unmatched),
       count({}, "scans", &Row::scans)},
      cases_of(benchmark));
}

/// The names of the series, in the order of the rows.
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

std::vector<BenchReport::Plot> plots_of(const RobustnessBenchmark& benchmark) {
  std::vector<BenchReport::Plot> plots;
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
        line.values.push_back(over_seeds(runs, &RobustnessRow::translation_error_m));
      }
      plot.lines.push_back(std::move(line));
    }
    plots.push_back({file_of(series), growth_svg(plot)});
  }
  return plots;
}

std::string markdown_of(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                        const std::string& machine) {
  std::string text =
      "# Degraded logs\n\nThis page shows how the maps get worse if odometry is noisy or missing, scans are "
      "rare or the field of view is narrow.\n\n" +
      measured_by(machine) + "; " + seeds_text(seeds) +
      " of the noise. Errors are means over the relations.\n\n";
  text +=
      "- odometry noise × k: each step of odometry gets normal noise of √(k² - 1) times its natural noise, "
      "so that its error grows to about k times its original value. The natural noise is measured over "
      "stretches of 1 m or 1 rad, against the map of the original log. It is a random walk: its variance "
      "grows with distance and rotation\n"
      "- no odometry: the constant-velocity model predicts the pose\n"
      "- scans kept: all other scans are removed. Relations at the times of removed scans use interpolated "
      "poses, and the error of the interpolation is included\n"
      "- field of view: beams outside it count as no returns\n"
      "- precision, recall: of the accepted loops, judged by the relations\n"
      "- unmatched: scans that the front end could not match with the active local map\n"
      "- runs: one per seed if the case uses random numbers, otherwise one. With several runs, errors are "
      "mean ± sample standard deviation [worst] and other figures are means\n"
      "\n";
  return text + noise_table(benchmark.logs).markdown() + '\n' + cases_table(benchmark).markdown() + '\n' +
         logs_section(benchmark.identities, benchmark.without_relations);
}

}  // namespace

BenchReport robustness_report(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                              const std::string& machine) {
  const ReportTable cases = cases_table(benchmark);
  return {"robustness.md", markdown_of(benchmark, seeds, machine),
          json_file_text(report_json("psi-slam-robustness", machine,
                                     {{"seeds", seeds.all()},
                                      {"files", logs_table(benchmark.identities).json()},
                                      {"logs", noise_table(benchmark.logs).json()},
                                      {"rows", cases.json()}})),
          cases.csv(), plots_of(benchmark)};
}

}  // namespace psi_slam
