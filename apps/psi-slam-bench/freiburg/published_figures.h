// SPDX-License-Identifier: BSD-3-Clause
// What others reached on the logs of the Freiburg benchmark: figures that they published, and figures that
// their programs gave on these very logs. Each system says where its figures come from.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "freiburg/freiburg_run.h"

namespace psi_slam {

/// A mean over the relations, with its standard deviation where that was published.
struct PublishedFigure {
  double mean = 0;
  std::optional<double> std;
  bool unchecked = false;  ///< quoted from memory of its source, not compared with it
};

/// In the order of kPathFigures; what was not published is empty.
using PublishedErrors = std::array<std::optional<PublishedFigure>, kPaperFigures>;

struct PublishedLog {
  std::string log;  ///< a name of benchmark_log_titles()
  PublishedErrors errors;
};

struct PublishedSystem {
  std::string name;    ///< the head of its column
  std::string source;  ///< a sentence, or several
  std::vector<PublishedLog> logs;

  /// None where it has nothing for that log.
  const PublishedErrors* errors_of(const std::string& log) const;
};

const std::vector<PublishedSystem>& published_systems();

/// The six logs of the benchmark: as files are named, and as people know them.
struct BenchmarkLogTitle {
  std::string log;
  std::string title;
};
const std::vector<BenchmarkLogTitle>& benchmark_log_titles();

/// "hospital" is "fr-hospital"; every other name is itself.
std::string benchmark_log_name(const std::string& name);

/// As people know it; a log that is none of the benchmark's by its own name.
std::string benchmark_log_title(const std::string& name);

}  // namespace psi_slam
