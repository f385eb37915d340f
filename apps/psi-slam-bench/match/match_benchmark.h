// SPDX-License-Identifier: BSD-3-Clause
// Compares the matchers: runs every candidate on every case.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "batch/workers.h"
#include "common/bench_report.h"
#include "match/candidates.h"
#include "match/loop_cases.h"
#include "match/match_figures.h"

namespace psi_slam {

/// Cases of one kind, drawn from every log: one table of the report.
struct MatchSeries {
  std::string title;
  CaseOptions cases;
  std::size_t nodes_per_local_map = FrontEndOptions().nodes_per_local_map;
  CandidateSet set = CandidateSet::kAll;

  struct Row {
    std::string matcher;
    MatchTally tally;
  };
  std::vector<Row> rows;  ///< by candidate, of the cases run so far; the first is exact CSM
};

struct MatchBenchmarkOptions {
  std::size_t cases = 250;  ///< positive and negative cases from each log
  std::uint64_t seed = 1;
  bool windows = false;  ///< also compare over window sizes and sizes of local maps
};

/// Use of a log in the benchmark.
struct LogNote {
  std::string name;
  std::string md5;  ///< of the log file
  std::optional<double> translation_error_m;
  std::size_t positive = 0;  ///< cases of the first series
  std::size_t negative = 0;
  std::string remark;  ///< reason for leaving the log out, or missing cases; may be empty
  bool used = true;
};

struct MatchBenchmark {
  std::vector<LogNote> logs;
  MatchSeries scans;
  MatchSeries contexts;
  std::vector<MatchSeries> windows;     ///< by half-width; may be empty
  std::vector<MatchSeries> local_maps;  ///< by nodes of a local map; may be empty
};

/// Largest error of a map over the true relations for which its poses serve as truth.
inline constexpr double kTrustedError_m = 0.2;

/// Runs every candidate on every case in this thread, case by case, and adds the results to the rows of the
/// series. Calls `after_case` after each case.
void run_cases(const std::vector<LoopCase>& cases, const std::vector<MatchCandidate>& candidates,
               double accepted_response, MatchSeries& series, const std::function<void()>& after_case);

/// Maps each log, draws its cases and runs them. Throws UserError when no log can be used.
MatchBenchmark run_match_benchmark(const std::vector<BenchmarkLog>& logs,
                                   const MatchBenchmarkOptions& options, const ProgressObserver& observer);

/// The report of the `match` command. JSON has the rows of the single scans as "matchers", and those of scans
/// with their context as "context", over window sizes as "windows" and over sizes of local maps as
/// "local_maps". A rate without cases is null. CSV has the rows of all series.
BenchReport match_report(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                         const std::string& machine);

/// Plots of the mean time as SVG: over the half-width of the window, and over the size of the local maps.
std::string window_plot(const MatchBenchmark& benchmark);
std::string local_map_plot(const MatchBenchmark& benchmark);

}  // namespace psi_slam
