// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_comparison.h"

#include <algorithm>

#include "base/number_text.h"
#include "batch/report_table.h"
#include "common/log_plots.h"
#include "freiburg/freiburg_benchmark.h"

namespace psi_slam {
namespace {

/// The matcher whose figures represent psi-slam.
std::string our_matcher(const FreiburgBenchmark& benchmark) {
  for (const FreiburgCell& cell : benchmark.cells)
    if (cell.matcher == "adaptive") return cell.matcher;
  return benchmark.cells.empty() ? "adaptive" : benchmark.cells.front().matcher;
}

/// The logs of the Freiburg benchmark, then other mapped logs.
std::vector<BenchmarkLogTitle> logs_of(const FreiburgBenchmark& benchmark) {
  std::vector<BenchmarkLogTitle> logs = benchmark_log_titles();
  for (const LogIdentity& log : benchmark.logs) {
    const std::string name = benchmark_log_name(log.name);
    if (std::none_of(logs.begin(), logs.end(), [&](const auto& known) { return known.log == name; }))
      logs.push_back({name, name});
  }
  return logs;
}

std::optional<CellFigures> our_figures(const FreiburgBenchmark& benchmark, const std::string& matcher,
                                       const std::string& log) {
  for (const FreiburgCell& cell : benchmark.cells)
    if (cell.matcher == matcher && benchmark_log_name(cell.log) == log) return figures_of(cell);
  return std::nullopt;
}

std::string column_name(const BaselineProgram& baseline) {
  return "MRPT " + baseline.kind.name + " (run here)";
}

std::string source_of(const BaselineProgram& baseline) {
  return baseline.version + ", run here on the same log, every scan, with " +
         baseline.config.filename().string() +
         " as shipped; changed settings: " + changes_text(baseline.kind) + ". " + baseline.kind.remark;
}

PublishedErrors errors_of(const RunFigures& figures) {
  PublishedErrors errors;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const MeanAndStd& one = figures.errors.*kPathFigures[i].errors;
    errors[i] = PublishedFigure{one.mean, one.std};
  }
  return errors;
}

/// The baselines that were run here, in the form of published systems.
std::vector<PublishedSystem> baseline_systems(const FreiburgBenchmark& benchmark) {
  std::vector<PublishedSystem> systems;
  for (const BaselineProgram& baseline : benchmark.baselines.programs) {
    PublishedSystem system{column_name(baseline), source_of(baseline), {}};
    for (const BaselineResult& result : benchmark.baseline_results)
      if (result.baseline == baseline.kind.name && result.figures)
        system.logs.push_back({benchmark_log_name(result.log), errors_of(*result.figures)});
    systems.push_back(std::move(system));
  }
  return systems;
}

void mark_best(ComparisonRow& row) {
  std::optional<double> least;
  for (const auto& value : row.values)
    if (value && (!least || value->mean < *least)) least = value->mean;
  for (const auto& value : row.values) row.best.push_back(value && value->mean == *least);
}

constexpr const char* kUncheckedMark = " †";
constexpr const char* kFailedMark = " ‡";

std::string value_text(const PublishedFigure& value) {
  constexpr int kDecimals = 4;
  return fixed_text(value.mean, kDecimals) + (value.std ? " ± " + fixed_text(*value.std, kDecimals) : "") +
         (value.unchecked ? kUncheckedMark : "");
}

ReportCell cell_of(const Comparison& comparison, const ComparisonRow& row, std::size_t column) {
  if (!row.values[column]) return empty_cell();
  const bool some_failed = comparison.columns[column].ours && row.failed > 0;
  return {value_text(*row.values[column]) + (some_failed ? kFailedMark : ""), {}, row.best[column]};
}

/// The footnotes for the marks in the table.
std::string footnotes(const std::string& table) {
  std::string text;
  if (table.find(kUncheckedMark) != std::string::npos)
    text += "\n† quoted from memory and not checked against the source.\n";
  if (table.find(kFailedMark) != std::string::npos)
    text += "\n‡ some runs failed; the mean is over the others.\n";
  return text;
}

}  // namespace

Comparison compare_with_others(const FreiburgBenchmark& benchmark) {
  const std::string matcher = our_matcher(benchmark);
  Comparison comparison;
  comparison.columns.push_back({"psi-slam, " + matcher, "this benchmark, averaged over all seeds.", true});
  std::vector<PublishedSystem> others = baseline_systems(benchmark);
  others.insert(others.end(), published_systems().begin(), published_systems().end());
  for (const PublishedSystem& system : others)
    comparison.columns.push_back({system.name, system.source, false});
  for (const BenchmarkLogTitle& log : logs_of(benchmark)) {
    const auto ours = our_figures(benchmark, matcher, log.log);
    for (std::size_t figure = 0; figure < kPaperFigures; ++figure) {
      ComparisonRow row{log.title, figure, {}, {}, ours ? ours->failed : 0};
      row.values.emplace_back();
      if (ours) {
        const MeanAndStd& errors = ours->errors.*kPathFigures[figure].errors;
        row.values.back() = PublishedFigure{errors.mean, errors.std};
      }
      for (const PublishedSystem& system : others) {
        const PublishedErrors* errors = system.errors_of(log.log);
        row.values.push_back(errors != nullptr ? (*errors)[figure] : std::nullopt);
      }
      mark_best(row);
      comparison.rows.push_back(std::move(row));
    }
  }
  return comparison;
}

std::string comparison_table(const Comparison& comparison) {
  ReportTable table{{{"log", {}, true}, {"error", {}, true}}, {}};
  for (const ComparisonColumn& column : comparison.columns) table.columns.push_back({column.name});
  for (const ComparisonRow& row : comparison.rows) {
    std::vector<ReportCell>& cells = table.rows.emplace_back();
    cells = {cell(row.log), cell(kPathFigures[row.figure].name)};
    for (std::size_t i = 0; i < row.values.size(); ++i) cells.push_back(cell_of(comparison, row, i));
  }
  const std::string text = table.markdown();
  return text + footnotes(text);
}

std::string comparison_plot(const Comparison& comparison, const std::string& log) {
  for (const ComparisonRow& row : comparison.rows) {
    if (row.log != log || row.figure != 0) continue;
    BarPlot plot{log + ": mean translational error (logarithmic)", "m", {}};
    bool any_of_ours = false;
    for (std::size_t i = 0; i < row.values.size(); ++i) {
      const ComparisonColumn& column = comparison.columns[i];
      if (!row.values[i]) continue;
      plot.bars.push_back({column.name, row.values[i]->mean, column.ours});
      any_of_ours = any_of_ours || column.ours;
    }
    return any_of_ours ? bar_svg(plot) : std::string();
  }
  return {};
}

}  // namespace psi_slam
