// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of the matchers: every matcher on every case.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"
#include "match/candidates.h"
#include "match/loop_cases.h"
#include "match/match_figures.h"

namespace psi_slam {

/// A table: cases of one kind, drawn from every log.
struct MatchSeries {
  std::string title;
  CaseOptions cases;
  std::size_t nodes_per_local_map = FrontEndOptions().nodes_per_local_map;
  CandidateSet set = CandidateSet::kAll;

  struct Row {
    std::string matcher;
    MatchTally tally;
  };
  std::vector<Row> rows;  ///< as far as cases were run; the first is exact CSM
};

struct MatchBenchmarkOptions {
  std::size_t cases = 250;  ///< of each kind from each log
  std::uint64_t seed = 1;
  bool windows = false;  ///< also over window sizes and sizes of local maps
};

/// What became of a log.
struct LogNote {
  std::string name;
  std::string md5;  ///< of the file
  std::optional<double> translation_error_m;
  std::size_t positive = 0;  ///< cases of the first series
  std::size_t negative = 0;
  std::string remark;  ///< why it is left out, or what it could not give; else empty
  bool used = true;
};

struct MatchBenchmark {
  std::vector<LogNote> logs;
  MatchSeries scans;
  MatchSeries contexts;
  std::vector<MatchSeries> windows;     ///< by half-width; empty unless asked for
  std::vector<MatchSeries> local_maps;  ///< by nodes a local map; empty unless asked for
};

/// Is told what is being done, and how much of all the work that counts for the time left is done.
using BenchObserver = std::function<void(const std::string& doing, double done, double all)>;

/// A map farther from the true relations than this is no truth to draw cases from.
inline constexpr double kTrustedError_m = 0.2;

/// Runs every candidate on every case, interleaved case by case, in this thread, and adds to the rows of the
/// series, which has none or those of these candidates. `after_case` is called after every case.
void run_cases(const std::vector<LoopCase>& cases, const std::vector<Candidate>& candidates,
               double accepted_response, MatchSeries& series, const std::function<void()>& after_case);

/// Maps the logs one by one, draws and runs their cases. Throws UserError when no log can be used.
MatchBenchmark run_match_benchmark(const std::vector<BenchmarkLog>& logs,
                                   const MatchBenchmarkOptions& options, const BenchObserver& observer);

}  // namespace psi_slam
