// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_benchmark.h"

#include <algorithm>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "freiburg/freiburg_comparison.h"
#include "map/report/html_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

/// A cell of the benchmark with its figures, which are empty if every run failed.
struct CellRow {
  const FreiburgCell* cell;
  std::optional<CellFigures> figures;
};

using CellColumn = ColumnOf<CellRow>;

std::vector<CellRow> rows_of(const FreiburgBenchmark& benchmark, bool with_failed) {
  std::vector<CellRow> rows;
  for (const FreiburgCell& cell : benchmark.cells)
    if (const auto figures = figures_of(cell); figures || with_failed) rows.push_back({&cell, figures});
  return rows;
}

/// Text of the column "runs": "10", "8, 2 failed", "1 run: draws no random numbers", or the reason if every
/// run failed.
std::string runs_text(const CellRow& row) {
  if (!row.figures) return "failed: " + row.cell->runs.front().failure;
  std::string text = std::to_string(row.figures->runs);
  if (row.figures->failed > 0) text += ", " + std::to_string(row.figures->failed) + " failed";
  if (!draws_random_numbers(row.cell->matcher)) text += " run: draws no random numbers";
  return text;
}

/// Column with the cells that `cell_of` makes from the figures of each row; empty cells without figures.
template <class Row = CellRow, class CellOf>
ColumnOf<Row> figure_column(const std::string& head, const std::string& key, const CellOf& cell_of) {
  return {{head, key}, [=](const Row& row) { return row.figures ? cell_of(*row.figures) : empty_cell(); }};
}

/// A column with the mean over the seeds in Markdown, and all statistics in JSON and CSV.
CellColumn mean_column(const std::string& head, const std::string& key, SeedSpread CellFigures::*spread,
                       int decimals) {
  return figure_column(head, key, [=](const CellFigures& figures) {
    const SeedSpread& over_seeds = figures.*spread;
    return ReportCell{fixed_text(over_seeds.mean, decimals), spread_json(over_seeds)};
  });
}

std::vector<CellColumn> name_columns() {
  return {{{"log", "log", true}, [](const CellRow& row) { return cell(row.cell->log); }},
          {{"matcher", "matcher", true}, [](const CellRow& row) { return cell(row.cell->matcher); }},
          {{{}, "random"},
           [](const CellRow& row) {
             return ReportCell{{}, draws_random_numbers(row.cell->matcher)};
           }},
          {{"runs", "runs", true}, [](const CellRow& row) {
             return ReportCell{runs_text(row), row.figures ? row.figures->runs : 0};
           }}};
}

Json failed_runs(const FreiburgCell& cell) {
  Json failed = Json::array();
  for (const FreiburgResult& run : cell.runs)
    if (!run.figures) failed.push_back({{"seed", run.seed}, {"reason", run.failure}});
  return failed;
}

ReportTable matchers_table(const FreiburgBenchmark& benchmark) {
  std::vector<CellColumn> columns = name_columns();
  columns.push_back({{{}, "failed"}, [](const CellRow& row) {
                       return ReportCell{{}, failed_runs(*row.cell)};
                     }});
  for (std::size_t i = 0; i < kPathFigures.size(); ++i)
    columns.push_back(
        figure_column(kPathFigures[i].name, kPathFigures[i].key, [i](const CellFigures& figures) {
          const MeanAndStd& errors = figures.errors.*kPathFigures[i].errors;
          const SeedSpread& spread = figures.spread[i];
          return ReportCell{
              errors_text(errors),
              {{"mean", errors.mean},
               {"std", errors.std},
               {"over_seeds", {{"std", spread.std}, {"min", spread.min}, {"max", spread.max}}}}};
        }));
  using Figures = CellFigures;
  const std::vector<CellColumn> others{
      figure_column("relations used", "relations_used",
                    [](const Figures& figures) { return cell(figures.relations_used, 0); }),
      figure_column({}, "relations_skipped",
                    [](const Figures& figures) { return cell(figures.relations_skipped, 0); }),
      mean_column("loops accepted", "loops_accepted", &Figures::loops_accepted, 1),
      figure_column("false of judged", {},
                    [](const Figures& figures) {
                      return cell(fixed_text(figures.loops_false.mean, 1) + " of " +
                                  fixed_text(figures.loops_judged.mean, 1));
                    }),
      mean_column({}, "loops_judged", &Figures::loops_judged, 1),
      mean_column({}, "loops_false", &Figures::loops_false, 1),
      figure_column("recall %", "loop_recall",
                    [](const Figures& figures) {
                      const auto& recall = figures.loop_recall;
                      return recall ? ReportCell{fixed_text(100 * recall->mean, 1), spread_json(*recall)}
                                    : ReportCell{"–", nullptr};
                    }),
      mean_column("wall [s]", "wall_s", &Figures::wall_s, 2),
      mean_column("CPU [s]", "cpu_s", &Figures::cpu_s, 2),
      mean_column("× real time", "real_time_factor", &Figures::real_time_factor, 0),
      mean_column("peak [MiB]", "peak_memory_mib", &Figures::peak_memory_mib, 0)};
  columns.insert(columns.end(), others.begin(), others.end());
  return table_of(columns, rows_of(benchmark, true));
}

ReportTable spread_table(const FreiburgBenchmark& benchmark) {
  std::vector<CellColumn> columns = name_columns();
  columns.back().column.is_text = false;
  for (std::size_t i = 0; i < kPaperFigures; ++i)
    columns.push_back({{kPathFigures[i].name}, [i](const CellRow& row) {
                         if (!draws_random_numbers(row.cell->matcher)) return cell("0 by construction");
                         const SeedSpread& spread = row.figures->spread[i];
                         if (spread.count < 2) return empty_cell();
                         return cell(fixed_text(spread.std, 5) + " (" + fixed_text(spread.min, 4) + " – " +
                                     fixed_text(spread.max, 4) + ')');
                       }});
  return table_of(columns, rows_of(benchmark, false));
}

std::string failures_text(const FreiburgBenchmark& benchmark) {
  std::string text;
  for (const FreiburgCell& cell : benchmark.cells)
    for (const FreiburgResult& run : cell.runs)
      if (!run.figures)
        text += "- " + cell.log + ", " + cell.matcher + ", seed " + std::to_string(run.seed) +
                ": failed: " + run.failure + '\n';
  return text.empty() ? text : "## Runs that failed\n\n" + text + '\n';
}

/// Lists the logs of the Freiburg benchmark that were not mapped, with the reasons.
std::string missing_text(const FreiburgBenchmark& benchmark) {
  std::string text;
  for (const BenchmarkLogTitle& title : benchmark_log_titles()) {
    const auto names_it = [&](const std::string& name) { return benchmark_log_name(name) == title.log; };
    const auto has_it = [&](const std::vector<std::string>& names) {
      return std::any_of(names.begin(), names.end(), names_it);
    };
    if (std::any_of(benchmark.logs.begin(), benchmark.logs.end(),
                    [&](const LogIdentity& log) { return names_it(log.name); }))
      continue;
    text += "- " + title.title + ": " +
            (has_it(benchmark.without_relations) ? "its log is in the folder without relations."
             : has_it(benchmark.left_out)        ? "--logs does not name its log."
                                                 : "its log is not in the folder.") +
            '\n';
  }
  return text.empty() ? text : text + '\n';
}

ReportTable baselines_table(const std::vector<BaselineResult>& results) {
  using Run = BaselineResult;
  std::vector<ColumnOf<Run>> columns{column("log", {}, &Run::log), column("system", {}, &Run::baseline)};
  const auto add = [&columns](const std::string& head, const auto& cell_of) {
    columns.push_back(figure_column<Run>(head, {}, cell_of));
  };
  for (const PathFigure& figure : kPathFigures)
    add(figure.name, [&](const RunFigures& run) { return cell(errors_text(run.errors.*figure.errors)); });
  columns[2].cell_of = [shown = columns[2].cell_of](const Run& run) {
    if (run.figures) return shown(run);
    return cell(run.not_finished_in_s ? "not finished in " + fixed_text(*run.not_finished_in_s, 0) + " s"
                                      : "failed: " + run.failure);
  };
  add("relations used", [](const RunFigures& run) { return cell(run.relations_used); });
  add("wall [s]", [](const RunFigures& run) { return cell(run.wall_s, 2); });
  add("CPU [s]", [](const RunFigures& run) { return cell(run.cpu_s, 2); });
  add("× real time", [](const RunFigures& run) { return cell(run.real_time_factor(), 0); });
  add("peak [MiB]", [](const RunFigures& run) { return cell(run.peak_memory_mib, 0); });
  return table_of(columns, results);
}

std::string baselines_text(const FreiburgBenchmark& benchmark) {
  if (benchmark.baselines.programs.empty() && benchmark.baselines.missing.empty()) return {};
  std::string text = "## Baselines run here\n\n";
  for (const BaselineProgram& baseline : benchmark.baselines.programs)
    text += "- " + baseline.kind.name + ": " + baseline.version + ", with " + baseline.config.string() +
            " as shipped, except for its output folder and " + changes_text(baseline.kind) + '\n';
  for (const std::string& missing : benchmark.baselines.missing) text += "- not run: " + missing + '\n';
  text +=
      "\nEach baseline ran once. It received every scan of the log as read by psi-slam, with the same "
      "odometry and the same laser mount. Times and memory: of its whole process, which reads the log, maps "
      "it and writes path and map.\n\n";
  if (!benchmark.baseline_results.empty())
    text += baselines_table(benchmark.baseline_results).markdown() + '\n';
  return text;
}

Json baselines_json(const FreiburgBenchmark& benchmark) {
  Json programs = Json::array();
  for (const BaselineProgram& baseline : benchmark.baselines.programs)
    programs.push_back({{"rival", baseline.kind.name},
                        {"version", baseline.version},
                        {"sha256", baseline.sha256},
                        {"config", baseline.config.string()},
                        {"changes", changes_text(baseline.kind)}});
  Json runs = Json::array();
  for (const BaselineResult& result : benchmark.baseline_results) {
    Json run = {{"log", result.log}, {"rival", result.baseline}};
    if (result.figures) run["figures"] = run_figures_json(*result.figures);
    if (result.not_finished_in_s) run["not_finished_in_s"] = *result.not_finished_in_s;
    if (!result.failure.empty()) run["failure"] = result.failure;
    runs.push_back(run);
  }
  return {{"programs", programs}, {"missing", benchmark.baselines.missing}, {"runs", runs}};
}

Json comparison_json(const Comparison& comparison) {
  Json rows = Json::array();
  for (const ComparisonRow& row : comparison.rows) {
    Json systems = Json::array();
    for (std::size_t i = 0; i < row.values.size(); ++i) {
      if (!row.values[i]) continue;
      const PublishedFigure& value = *row.values[i];
      systems.push_back({{"system", comparison.columns[i].name},
                         {"mean", value.mean},
                         {"std", value.std ? Json(*value.std) : Json(nullptr)},
                         {"failed_runs", value.failed_runs},
                         {"best", static_cast<bool>(row.best[i])}});
    }
    rows.push_back({{"log", row.log}, {"figure", kPathFigures[row.figure].key}, {"systems", systems}});
  }
  return rows;
}

std::string markdown_of(const FreiburgBenchmark& benchmark, const Comparison& comparison,
                        const FreiburgOptions& options, const std::string& machine) {
  const std::string runs = counted(static_cast<std::size_t>(options.processes), "run", "runs");
  std::string text =
      "# Freiburg benchmark\n\nThis page compares psi-slam with other SLAM systems on the logs of the "
      "Freiburg benchmark.\n\n" +
      measured_by(machine) + ", " + (options.processes == 1 ? "" : "at most ") + runs + " at a time with " +
      counted(static_cast<std::size_t>(options.threads), "thread", "threads") + " each, " +
      seeds_text(options.seeds) + ".\n\n";
  text +=
      "- errors: metric of Kümmerle et al. 2009, mean ± standard deviation over all relations, "
      "averaged over all seeds\n"
      "- translation, Cartographer's variant: translational error as computed by the tool of Hess et al.\n"
      "- false of judged: accepted loops that a relation contradicts, out of those that a relation "
      "can judge; averaged over all seeds\n"
      "- recall: share of the relations between two visits to a place whose neighbourhoods a loop joins; "
      "averaged over all seeds\n"
      "- times and memory: of the whole process, which reads the log, maps it and evaluates the path, but "
      "draws no map\n"
      "- × real time: length of the recording divided by wall time\n"
      "\n";
  std::string sources;
  for (const PublishedSystem& system : comparison.columns)
    sources += "- " + system.name + ": " + system.source + '\n';
  text +=
      "## psi-slam and other systems\n\n" + comparison_table(comparison) +
      "\nSystems may be tuned to these places. The authors of Cartographer write: \"Since each public data "
      "set has a unique sensor configuration, we cannot be sure that we did not also fit our parameters to "
      "the specific locations.\" The same holds for psi-slam: its defaults were chosen on the five logs "
      "that it maps here.\n\nBold marks the smallest mean of each row. Systems marked \"live\" or \"run "
      "here\" mapped these "
      "logs; figures of failed maps are included. Sources of the figures:\n\n" +
      sources + '\n' + missing_text(benchmark);
  text += baselines_text(benchmark);
  text += "## Every matcher on every log\n\n" + matchers_table(benchmark).markdown() + '\n';
  text +=
      "## Spread of the means over the seeds\n\nSample standard deviation (minimum – maximum) of the means; "
      "– if there is a single run only.\n\n" +
      spread_table(benchmark).markdown() + '\n';
  return text + failures_text(benchmark) + logs_section(benchmark.logs, benchmark.without_relations);
}

}  // namespace

BenchReport freiburg_report(const FreiburgBenchmark& benchmark, const FreiburgOptions& options,
                            const std::string& machine) {
  const Comparison comparison = compare_with_others(benchmark);
  const ReportTable matchers = matchers_table(benchmark);
  BenchReport report{"freiburg.md",
                     markdown_of(benchmark, comparison, options, machine),
                     json_file_text(report_json("psi-slam-freiburg-benchmark", machine,
                                                {{"seeds", options.seeds.all()},
                                                 {"processes", options.processes},
                                                 {"threads", options.threads},
                                                 {"logs", logs_table(benchmark.logs).json()},
                                                 {"cells", matchers.json()},
                                                 {"rivals", baselines_json(benchmark)},
                                                 {"comparison", comparison_json(comparison)}})),
                     matchers.csv(),
                     {}};
  for (const LogIdentity& log : benchmark.logs) {
    const std::string plot = comparison_plot(comparison, benchmark_log_title(log.name));
    if (!plot.empty()) report.plots.push_back({"freiburg-" + log.name + ".svg", plot});
  }
  return report;
}

}  // namespace psi_slam
