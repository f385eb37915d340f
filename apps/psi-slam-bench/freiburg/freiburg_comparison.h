// SPDX-License-Identifier: BSD-3-Clause
// Ours beside the others: a column for each system, a row for each figure of each log.
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
  std::size_t figure;                                  ///< of kPathFigures
  std::vector<std::optional<PublishedFigure>> values;  ///< by column
  std::vector<bool> best;  ///< by column: of the least mean of the row; several when they are equal
  std::size_t failed = 0;  ///< of our runs: ours is the mean of the others
};

struct Comparison {
  std::vector<ComparisonColumn> columns;
  std::vector<ComparisonRow> rows;  ///< four for each of the benchmark's logs, then for each other log mapped
};

/// Ours is the adaptive matcher, or the first of those that ran if it did not.
Comparison compare_with_others(const FreiburgBenchmark& benchmark);

/// A Markdown table, the best of each row bold. Ours is marked where some of its runs failed, and so are the
/// figures of others that are unchecked; the footnotes to the marks that are there follow the table.
std::string comparison_table(const Comparison& comparison);

/// A page of bars of the mean translational error for a log by title ("Intel"); empty where no run of ours
/// has one.
std::string comparison_plot(const Comparison& comparison, const std::string& log);

}  // namespace psi_slam
