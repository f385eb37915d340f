// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "common/log_plots.h"
#include "sparse/sparse_benchmark.h"

namespace psi_slam {
namespace {

/// Runs of one case on one log, with different seeds.
using Runs = std::vector<SparseRow>;
using Column = ColumnOf<Runs>;

/// Column with the mean over the seeds in Markdown, and all statistics in JSON.
template <class ValueOf>
Column mean_column(const std::string& head, const std::string& key, int decimals, const ValueOf& value_of) {
  return {{head, key}, [=](const Runs& runs) {
            const SeedSpread spread = spread_over(runs, value_of);
            return ReportCell{fixed_text(spread.mean, decimals), spread_json(spread)};
          }};
}

/// Column with the mean and standard deviation over the relations, averaged over the seeds.
Column error_column(const std::string& head, const std::string& key, MeanAndStd PathErrors::*errors) {
  return {{head, key}, [=](const Runs& runs) {
            const auto over_seeds = [&](double MeanAndStd::*part) {
              return spread_over(runs,
                                 [&](const SparseRow& run) { return run.figures.errors.*errors.*part; });
            };
            const SeedSpread mean = over_seeds(&MeanAndStd::mean);
            const double std = over_seeds(&MeanAndStd::std).mean;
            return ReportCell{errors_text({mean.mean, std}),
                              {{"mean", mean.mean}, {"std", std}, {"over_seeds", spread_json(mean)}}};
          }};
}

/// Column with the mean of a ratio, over the runs that have the ratio.
Column ratio_column(const std::string& head, const std::string& key,
                    std::optional<double> NodeCosts::*ratio) {
  return {{head, key}, [=](const Runs& runs) {
            std::vector<double> known;
            for (const SparseRow& run : runs)
              if (run.costs.*ratio) known.push_back(*(run.costs.*ratio));
            const SeedSpread spread = spread_of(known);
            return ReportCell{spread.count > 0 ? fixed_text(spread.mean, 1) : "–", spread_json(spread)};
          }};
}

ReportTable runs_table(const SparseBenchmark& benchmark) {
  using Row = SparseRow;
  return table_of<Runs>(
      {{{"log", "log", true}, [](const Runs& runs) { return cell(runs.front().log); }},
       {{"scans kept", "kept", true}, [](const Runs& runs) { return cell(runs.front().kept); }},
       {{{}, "seeds"},
        [](const Runs& runs) {
          return ReportCell{{}, seeds_of(runs)};
        }},
       mean_column("scans", "scans", 0, [](const Row& run) { return run.figures.scans; }),
       error_column("translation [m]", "translation_abs_m", &PathErrors::translation_abs_m),
       {{"floor [m]", "floor_m"}, [](const Runs& runs) { return cell(runs.front().floor_m, 4); }},
       error_column("rotation [deg]", "rotation_abs_deg", &PathErrors::rotation_abs_deg),
       mean_column({}, "relations", 0, [](const Row& run) { return run.figures.relations_used; }),
       mean_column("unmatched", "unmatched_scans", 0, [](const Row& run) { return run.unmatched; }),
       mean_column("loops", "loops", 0, [](const Row& run) { return run.loops; }),
       mean_column({}, "wall_s", 1, [](const Row& run) { return run.figures.wall_s; }),
       mean_column("CPU [s]", "cpu_s", 1, [](const Row& run) { return run.figures.cpu_s; }),
       mean_column({}, "nodes", 0, [](const Row& run) { return run.nodes; }),
       mean_column("node p50 [ms]", "node_ms.p50", 1, [](const Row& run) { return run.costs.p50_ms; }),
       mean_column("p99 [ms]", "node_ms.p99", 1, [](const Row& run) { return run.costs.p99_ms; }),
       mean_column("max [ms]", "node_ms.max", 1, [](const Row& run) { return run.costs.max_ms; }),
       ratio_column("max / median, time", "max_over_median.time", &NodeCosts::time_ratio),
       ratio_column("evaluations", "max_over_median.evaluations", &NodeCosts::evaluations_ratio)},
      by_case(benchmark.rows, [](const Row& a, const Row& b) { return a.log == b.log && a.kept == b.kept; }));
}

ReportTable sensors_table(const std::vector<SensorSweepRow>& rows) {
  using Row = SensorSweepRow;
  const auto exact = [](const std::string& head, const std::string& key, double Row::*value) {
    return ColumnOf<Row>{{head, key}, [=](const Row& row) {
                           return ReportCell{trimmed_text(row.*value, 2), row.*value};
                         }};
  };
  return table_of<Row>(
      {exact("range [m]", "max_range_m", &Row::max_range_m),
       exact("beams every [deg]", "spacing_deg", &Row::spacing_deg),
       exact("step [m]", "step_m", &Row::step_m), column("path [m]", "path_m", &Row::path_m, 0),
       column("scans", "scans", &Row::scans), column("error [m]", "error_m", &Row::error_m, 4),
       column("error [deg]", "error_deg", &Row::error_deg, 3),
       column("unmatched", "unmatched_scans", &Row::unmatched), column("loops", "loops", &Row::loops),
       column("false", "false_loops", &Row::false_loops)},
      rows);
}

/// The distinct values of a member, in the order of the rows.
std::vector<double> values_of(const std::vector<SensorSweepRow>& rows, double SensorSweepRow::*member) {
  std::vector<double> values;
  for (const SensorSweepRow& row : rows)
    if (std::find(values.begin(), values.end(), row.*member) == values.end()) values.push_back(row.*member);
  return values;
}

std::string picture_file(const SparseMapPicture& picture) {
  return "sparse-" + picture.log + ".png";
}

std::string range_text(double max_range_m) {
  return trimmed_text(max_range_m, 2) + " m";
}

std::string sweep_file(double max_range_m) {
  return "sparse-range-" + trimmed_text(max_range_m, 2) + "m.svg";
}

BenchReport::Plot sweep_plot(const std::vector<SensorSweepRow>& rows, double max_range_m) {
  GrowthPlot plot;
  plot.title = "Error over the step between scans, maximum range " + range_text(max_range_m);
  plot.unit = "m";
  for (const double step_m : values_of(rows, &SensorSweepRow::step_m))
    plot.labels.push_back(trimmed_text(step_m, 2) + " m");
  for (const double spacing_deg : values_of(rows, &SensorSweepRow::spacing_deg)) {
    GrowthPlot::Line line{trimmed_text(spacing_deg, 2) + " degrees", {}};
    for (const SensorSweepRow& row : rows)
      if (row.max_range_m == max_range_m && row.spacing_deg == spacing_deg)
        line.values.push_back(spread_of({row.error_m}));
    plot.lines.push_back(std::move(line));
  }
  return {sweep_file(max_range_m), growth_svg(plot)};
}

std::vector<BenchReport::Plot> plots_of(const SparseBenchmark& benchmark) {
  std::vector<BenchReport::Plot> plots;
  for (const SparseMapPicture& picture : benchmark.pictures)
    plots.push_back({picture_file(picture), picture.png});
  for (const double max_range_m : values_of(benchmark.sensors, &SensorSweepRow::max_range_m))
    plots.push_back(sweep_plot(benchmark.sensors, max_range_m));
  return plots;
}

std::string settings_sentence(const SparseOptions& options) {
  if (options.assignments.empty()) return "default settings";
  std::string text = "default settings except";
  for (const std::string& assignment : options.assignments) text += " `" + assignment + '`';
  return text;
}

std::string runs_section(const SparseBenchmark& benchmark) {
  if (benchmark.rows.empty()) return {};
  std::string text =
      "## Real logs\n\n"
      "- scans kept, 1 m / 0.5 rad: a dense log of the Freiburg benchmark, thinned to steps of odometry. The "
      "other scans get their poses back: the pose of the last kept scan, composed with odometry since. "
      "Scans are distinguished by their number, because some logs repeat time stamps\n"
      "- scans kept, 1 of n: a dense log, every nth scan. Relations at the times of removed scans use "
      "interpolated poses\n"
      "- scans kept, all: a log that is sparse as recorded. Its relations come from the result of another "
      "mapper, not from ground truth: errors of 0.03 to 0.05 m mean the same map\n"
      "- translation, rotation: metric of Kümmerle et al. 2009, mean ± standard deviation over the "
      "relations, averaged over the seeds; all other figures are means over the seeds\n"
      "- floor: translation error of a thinned log if its kept scans have their poses in the map of all "
      "scans. This part of the error comes from odometry between the kept scans\n"
      "- unmatched: scans that the front end could not match with the active local map, except the first\n"
      "- CPU: processor time of reading the log and mapping it with one thread, without drawing a map\n"
      "- node: processor time of a scan that becomes a node: the 50th and 99th percentile, and the longest. "
      "The work after the last scan is not counted\n"
      "- max / median: the most expensive node over the median of the nodes that tried loops, in time and "
      "in scored poses (evaluations)\n\n";
  return text + runs_table(benchmark).markdown() + '\n';
}

std::string pictures_section(const SparseBenchmark& benchmark) {
  if (benchmark.pictures.empty()) return {};
  std::string text = "## Maps of the sparse logs\n\n";
  for (const SparseMapPicture& picture : benchmark.pictures)
    text += picture.log + ":\n\n![map of " + picture.log + "](" + picture_file(picture) + ")\n\n";
  return text;
}

std::string sensors_section(const SparseBenchmark& benchmark) {
  if (benchmark.sensors.empty()) return {};
  std::string text =
      "## Simulated sensors\n\nEach run goes through a simulated building with rooms, corridors and glass, "
      "with a field of view of 180 degrees. All lengths of the building grow with the square root of the "
      "maximum range. Scans are one step or 0.5 rad of odometry apart; the shortest step keeps all scans. "
      "The error is the mean of the relations metric over random pairs of scans, against the exact "
      "truth.\n\n";
  for (const double max_range_m : values_of(benchmark.sensors, &SensorSweepRow::max_range_m))
    text += "![error for a maximum range of " + range_text(max_range_m) + "](" + sweep_file(max_range_m) +
            ")\n\n";
  return text +
         "- beams every: angle between neighbouring beams\n"
         "- false: loops kept by the map that contradict the truth\n\n" +
         sensors_table(benchmark.sensors).markdown() + '\n';
}

std::string markdown_of(const SparseBenchmark& benchmark, const SparseOptions& options,
                        const std::string& machine) {
  std::string text =
      "# Sparse logs\n\nThis page shows the maps of logs with few scans: about one scan for each metre, "
      "beams "
      "far apart, large halls and outdoors.\n\n" +
      measured_by(machine) + "; " + seeds_text(options.seeds) + ", " + settings_sentence(options) + ".\n\n";
  text += runs_section(benchmark) + pictures_section(benchmark) + sensors_section(benchmark);
  text +=
      "## Measure it again\n\n"
      "<!-- not run with the other commands: all parts take minutes; tests/bench has its tests -->\n"
      "```console\npsi-slam bench sparse --data benchmark-logs -o out/sparse\n```\n\n"
      "writes this page, its pictures and its plots into `out/sparse`. Sparse logs are expected in "
      "`benchmark-logs/sparse`, with relations beside them.\n";
  if (!benchmark.identities.empty())
    text += '\n' + logs_section(benchmark.identities, benchmark.without_relations);
  return text;
}

}  // namespace

BenchReport sparse_report(const SparseBenchmark& benchmark, const SparseOptions& options,
                          const std::string& machine) {
  const ReportTable runs = runs_table(benchmark);
  return {"sparse.md", markdown_of(benchmark, options, machine),
          json_file_text(report_json("psi-slam-sparse-benchmark", machine,
                                     {{"seeds", options.seeds.all()},
                                      {"settings", options.assignments},
                                      {"logs", logs_table(benchmark.identities).json()},
                                      {"rows", runs.json()},
                                      {"sensors", sensors_table(benchmark.sensors).json()}})),
          runs.csv(), plots_of(benchmark)};
}

}  // namespace psi_slam
