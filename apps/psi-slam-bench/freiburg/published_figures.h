// SPDX-License-Identifier: BSD-3-Clause
// Figures of other systems on the logs of the Freiburg benchmark: published ones, and results of their
// programs on these logs. Each system names the source of its figures.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "freiburg/freiburg_run.h"

namespace psi_slam {

/// A mean over the relations, with its standard deviation if that was published.
struct PublishedFigure {
  double mean = 0;
  std::optional<double> std;
  bool unchecked = false;  ///< quoted from memory and not checked against the source
};

/// In the order of kPathFigures; empty where nothing was published.
using PublishedErrors = std::array<std::optional<PublishedFigure>, kPaperFigures>;

struct PublishedLog {
  std::string log;  ///< a name of benchmark_log_titles()
  PublishedErrors errors;
};

struct PublishedSystem {
  std::string name;    ///< head of the column in the comparison
  std::string source;  ///< one or more sentences
  std::vector<PublishedLog> logs;

  /// Null if the system has no figures for that log.
  const PublishedErrors* errors_of(const std::string& log) const;
};

const std::vector<PublishedSystem>& published_systems();

/// One of the six logs of the benchmark: the name of its file and its usual name.
struct BenchmarkLogTitle {
  std::string log;
  std::string title;
};
const std::vector<BenchmarkLogTitle>& benchmark_log_titles();

/// "hospital" is "fr-hospital"; every other name is itself.
std::string benchmark_log_name(const std::string& name);

/// The usual name of a log of the benchmark; the name itself for other logs.
std::string benchmark_log_title(const std::string& name);

}  // namespace psi_slam
