// SPDX-License-Identifier: BSD-3-Clause
// Compares psi-slam with other systems in a table: a column for each system, a row for each error of each
// log. Figures of other systems are published, or measured by running their programs on the same logs. Each
// system names the source of its figures.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "freiburg/freiburg_benchmark.h"

namespace psi_slam {

/// A mean error over the relations, with its standard deviation if that was published.
struct PublishedFigure {
  double mean = 0;
  std::optional<double> std;
  std::size_t failed_runs = 0;  ///< failed runs of psi-slam, which the mean leaves out
};

/// Errors in the order and units of kPathFigures; empty where nothing was published.
using PublishedErrors = std::array<std::optional<PublishedFigure>, kPaperFigures>;

struct PublishedLog {
  std::string log;  ///< BenchmarkLogTitle::log: "intel"
  PublishedErrors errors;
};

struct PublishedSystem {
  std::string name;    ///< head of the column in the comparison
  std::string source;  ///< source of the figures, as one or more sentences
  std::vector<PublishedLog> logs;

  /// Errors on a log; null if the system has no figures for it.
  const PublishedErrors* errors_of(const std::string& log) const;
};

const std::vector<PublishedSystem>& published_systems();

/// One of the six logs of the benchmark: the name of its file and its usual name.
struct BenchmarkLogTitle {
  std::string log;
  std::string title;
};
const std::vector<BenchmarkLogTitle>& benchmark_log_titles();

/// Name of a log in benchmark_log_titles(): "fr-hospital" for "hospital", and `name` itself otherwise.
std::string benchmark_log_name(const std::string& name);

/// Usual name of a log of the Freiburg benchmark; `name` itself for all other logs.
std::string benchmark_log_title(const std::string& name);

struct ComparisonRow {
  std::string log;                                     ///< usual name of the log: "Intel"
  std::size_t figure;                                  ///< index in kPathFigures
  std::vector<std::optional<PublishedFigure>> values;  ///< one for each column
  std::vector<bool> best;  ///< for each column: true for the least mean of the row
};

struct Comparison {
  std::vector<PublishedSystem> columns;  ///< the first is psi-slam
  std::vector<ComparisonRow> rows;       ///< for each log, one row for each of its four errors
};

/// Compares all systems. The adaptive matcher represents psi-slam, or the first matcher if the adaptive one
/// was not run. Rows are the logs of the Freiburg benchmark, then all other mapped logs.
Comparison compare_with_others(const FreiburgBenchmark& benchmark);

/// Markdown table with the best figure of each row in bold. A footnote explains the mark of figures of
/// psi-slam with failed runs.
std::string comparison_table(const Comparison& comparison);

/// Bars of the mean translational error on the log with this title ("Intel"), as SVG. Empty without figures
/// of psi-slam.
std::string comparison_plot(const Comparison& comparison, const std::string& log);

}  // namespace psi_slam
