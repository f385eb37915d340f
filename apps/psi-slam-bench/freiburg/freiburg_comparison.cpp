// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_comparison.h"

#include <algorithm>

#include "common/bar_plot.h"
#include "freiburg/freiburg_figures.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

/// The matcher whose figures stand for us.
std::string our_matcher(const FreiburgBenchmark& benchmark) {
  for (const FreiburgCell& cell : benchmark.cells)
    if (cell.matcher == "adaptive") return cell.matcher;
  return benchmark.cells.empty() ? "adaptive" : benchmark.cells.front().matcher;
}

/// The benchmark's logs by its own order, then what else was mapped.
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
  return baseline.version + ", run here on the same log, every scan, with " + baseline.config.filename().string() +
         " as it ships; set otherwise: " + changes_text(baseline.kind) + ". " + baseline.kind.remark;
}

PublishedErrors errors_of(const RunFigures& figures) {
  PublishedErrors errors;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const MeanAndStd& one = figures.errors.*kPathFigures[i].errors;
    errors[i] = PublishedFigure{one.mean, one.std};
  }
  return errors;
}

/// The baselines that were run here, as systems like the others.
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

std::string cell_of(const Comparison& comparison, const ComparisonRow& row, std::size_t column) {
  if (!row.values[column]) return " – |";
  const bool some_failed = comparison.columns[column].ours && row.failed > 0;
  const std::string bold = row.best[column] ? "**" : "";
  return ' ' + bold + value_text(*row.values[column]) + (some_failed ? kFailedMark : "") + bold + " |";
}

/// To the marks of the table.
std::string footnotes(const std::string& table) {
  std::string text;
  if (table.find(kUncheckedMark) != std::string::npos)
    text += "\n† quoted from memory of the source and not compared with it: unchecked.\n";
  if (table.find(kFailedMark) != std::string::npos)
    text += "\n‡ some of these runs failed: the mean is that of the others.\n";
  return text;
}

}  // namespace

Comparison compare_with_others(const FreiburgBenchmark& benchmark) {
  const std::string matcher = our_matcher(benchmark);
  Comparison comparison;
  comparison.columns.push_back({"psi-slam, " + matcher, "this run: means over the seeds.", true});
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
  std::string text = "| log | error |";
  std::string rule = "|---|---|";
  for (const ComparisonColumn& column : comparison.columns) {
    text += ' ' + column.name + " |";
    rule += "---:|";
  }
  text += '\n' + rule + '\n';
  for (const ComparisonRow& row : comparison.rows) {
    text += "| " + row.log + " | " + kPathFigures[row.figure].name + " |";
    for (std::size_t i = 0; i < row.values.size(); ++i) text += cell_of(comparison, row, i);
    text += '\n';
  }
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
