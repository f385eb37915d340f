// SPDX-License-Identifier: BSD-3-Clause
// psi-slam compared with other systems: a column for each system, a row for each error of each log.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "freiburg/freiburg_benchmark.h"
#include "freiburg/published_figures.h"

namespace psi_slam {

struct ComparisonColumn {
  std::string name;
  std::string source;
  bool ours = false;
};

struct ComparisonRow {
  std::string log;                                     ///< "Intel"
  std::size_t figure;                                  ///< index in kPathFigures
  std::vector<std::optional<PublishedFigure>> values;  ///< by column
  std::vector<bool> best;                              ///< by column: true for the least mean of the row
  std::size_t failed = 0;  ///< number of our runs that failed; our figures are those of the others
};

struct Comparison {
  std::vector<ComparisonColumn> columns;
  std::vector<ComparisonRow> rows;  ///< four for each log
};

/// The adaptive matcher represents psi-slam, or the first matcher if the adaptive one was not run. Rows are
/// the logs of the Freiburg benchmark, then other mapped logs.
Comparison compare_with_others(const FreiburgBenchmark& benchmark);

/// A Markdown table with the best figure of each row in bold, followed by footnotes for marked figures: ours
/// if some runs failed, and published ones that are unchecked.
std::string comparison_table(const Comparison& comparison);

/// Bars of the mean translational error on the log with this title ("Intel"), as SVG. Empty without figures
/// of psi-slam.
std::string comparison_plot(const Comparison& comparison, const std::string& log);

}  // namespace psi_slam
