// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_comparison.h"

#include <algorithm>

#include "base/number_text.h"
#include "batch/report_table.h"
#include "common/log_plots.h"

namespace psi_slam {
namespace {

/// The matcher whose figures represent psi-slam.
std::string our_matcher(const FreiburgBenchmark& benchmark) {
  for (const FreiburgCell& cell : benchmark.cells)
    if (cell.matcher == "adaptive") return cell.matcher;
  return benchmark.cells.empty() ? "adaptive" : benchmark.cells.front().matcher;
}

/// The logs of the Freiburg benchmark, then all other mapped logs.
std::vector<BenchmarkLogTitle> logs_of(const FreiburgBenchmark& benchmark) {
  std::vector<BenchmarkLogTitle> logs = benchmark_log_titles();
  for (const LogIdentity& log : benchmark.logs) {
    const std::string name = benchmark_log_name(log.name);
    if (std::none_of(logs.begin(), logs.end(), [&](const auto& known) { return known.log == name; }))
      logs.push_back({name, name});
  }
  return logs;
}

PublishedErrors errors_of(const PathErrors& errors, std::size_t failed_runs = 0) {
  PublishedErrors published;
  for (std::size_t i = 0; i < published.size(); ++i) {
    const MeanAndStd& one = errors.*kPathFigures[i].errors;
    published[i] = PublishedFigure{one.mean, one.std, failed_runs};
  }
  return published;
}

PublishedSystem our_system(const FreiburgBenchmark& benchmark) {
  const std::string matcher = our_matcher(benchmark);
  PublishedSystem system{"psi-slam, " + matcher, "this benchmark, averaged over all seeds.", {}};
  for (const FreiburgCell& cell : benchmark.cells)
    if (const auto figures = cell.matcher == matcher ? figures_of(cell) : std::nullopt)
      system.logs.push_back({benchmark_log_name(cell.log), errors_of(figures->errors, figures->failed)});
  return system;
}

/// Figures of a baseline that this benchmark ran.
PublishedSystem baseline_system(const BaselineProgram& baseline, const std::vector<BaselineResult>& results) {
  PublishedSystem system{"MRPT " + baseline.kind.name + " (run here)",
                         baseline.version + ", run here on the same log, every scan, with " +
                             baseline.config.filename().string() + " as shipped; changed settings: " +
                             changes_text(baseline.kind) + ". " + baseline.kind.remark,
                         {}};
  for (const BaselineResult& result : results)
    if (result.baseline == baseline.kind.name && result.figures)
      system.logs.push_back({benchmark_log_name(result.log), errors_of(result.figures->errors)});
  return system;
}

void mark_best(ComparisonRow& row) {
  std::optional<double> least;
  for (const auto& value : row.values)
    if (value && (!least || value->mean < *least)) least = value->mean;
  for (const auto& value : row.values) row.best.push_back(value && value->mean == *least);
}

constexpr const char* kFailedMark = " ‡";

ReportCell cell_of(const std::optional<PublishedFigure>& value, bool best) {
  if (!value) return empty_cell();
  constexpr int kDecimals = 4;
  return {fixed_text(value->mean, kDecimals) +
              (value->std ? " ± " + fixed_text(*value->std, kDecimals) : "") +
              (value->failed_runs > 0 ? kFailedMark : ""),
          {},
          best};
}

/// Footnote that explains the mark in the table; empty without a mark.
std::string footnote(const std::string& table) {
  if (table.find(kFailedMark) == std::string::npos) return {};
  return "\n‡ some runs failed; the mean is over the successful runs.\n";
}

}  // namespace

Comparison compare_with_others(const FreiburgBenchmark& benchmark) {
  Comparison comparison{{our_system(benchmark)}, {}};
  std::vector<PublishedSystem>& systems = comparison.columns;
  for (const BaselineProgram& baseline : benchmark.baselines.programs)
    systems.push_back(baseline_system(baseline, benchmark.baseline_results));
  systems.insert(systems.end(), published_systems().begin(), published_systems().end());
  for (const BenchmarkLogTitle& log : logs_of(benchmark))
    for (std::size_t figure = 0; figure < kPaperFigures; ++figure) {
      ComparisonRow& row = comparison.rows.emplace_back(ComparisonRow{log.title, figure, {}, {}});
      for (const PublishedSystem& system : systems) {
        const PublishedErrors* errors = system.errors_of(log.log);
        row.values.push_back(errors != nullptr ? (*errors)[figure] : std::nullopt);
      }
      mark_best(row);
    }
  return comparison;
}

std::string comparison_table(const Comparison& comparison) {
  ReportTable table{{{"log", {}, true}, {"error", {}, true}}, {}};
  for (const PublishedSystem& system : comparison.columns) table.columns.push_back({system.name});
  for (const ComparisonRow& row : comparison.rows) {
    std::vector<ReportCell>& cells = table.rows.emplace_back();
    cells = {cell(row.log), cell(kPathFigures[row.figure].name)};
    for (std::size_t i = 0; i < row.values.size(); ++i) cells.push_back(cell_of(row.values[i], row.best[i]));
  }
  const std::string text = table.markdown();
  return text + footnote(text);
}

std::string comparison_plot(const Comparison& comparison, const std::string& log) {
  const auto row = std::find_if(comparison.rows.begin(), comparison.rows.end(),
                                [&](const ComparisonRow& one) { return one.log == log && one.figure == 0; });
  if (row == comparison.rows.end() || !row->values.front()) return {};
  BarPlot plot{log + ": mean translational error (logarithmic)", "m", {}};
  for (std::size_t i = 0; i < row->values.size(); ++i)
    if (const auto& value = row->values[i])
      plot.bars.push_back({comparison.columns[i].name, value->mean, i == 0});
  return bar_svg(plot);
}

}  // namespace psi_slam
