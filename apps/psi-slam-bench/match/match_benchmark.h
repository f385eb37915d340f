// SPDX-License-Identifier: BSD-3-Clause
// Compares the matchers: those of the settings, the one of the paper, and the genetic matcher with one of its
// steps switched off at a time. Runs every candidate on every case.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "batch/workers.h"
#include "common/bench_report.h"
#include "match/loop_cases.h"
#include "matching/matcher.h"

namespace psi_slam {

/// Largest distance of a successful match from the truth.
inline constexpr double kSuccess_m = 0.3;
inline constexpr double kSuccess_rad = radians_from_degrees(3.5L);

struct Judgement {
  bool success = false;       ///< positive cases: found within the limits above
  bool same_optimum = false;  ///< positive cases: at least as good as exact CSM's match, or none by either
  bool false_accept = false;  ///< negative cases: found with a response that loop closing would accept
};

/// `exact` is the match of exact CSM in the same case.
Judgement judge(const LoopCase& loop_case, const MatchResult& match, const MatchResult& exact,
                double accepted_response);

struct TimeFigures {
  double mean = 0;
  double p50 = 0;
  double p95 = 0;
  double p99 = 0;
};

struct MatchFigures {
  std::size_t cases = 0;
  std::size_t positive = 0;
  std::size_t negative = 0;
  std::optional<double> success_rate;       ///< of the positive cases; empty without positive cases
  std::optional<double> same_optimum_rate;  ///< of the positive cases; empty without positive cases
  std::optional<double> false_accept_rate;  ///< of the negative cases; empty without negative cases
  double evaluations = 0;                   ///< mean
  TimeFigures time_ms;
  /// Share of the decoded codes that lay outside the window.
  std::optional<double> repaired_share;
};

/// Sums up the figures of a matcher over the cases.
class MatchTally {
 public:
  void add(const LoopCase& loop_case, const Judgement& judgement, const MatchResult& match, double time_ms);

  /// The percentile p of n values is the value of rank floor(p n / 100), counted from 0.
  MatchFigures figures() const;

 private:
  std::size_t positive_ = 0;
  std::size_t negative_ = 0;
  std::size_t successes_ = 0;
  std::size_t same_optima_ = 0;
  std::size_t false_accepts_ = 0;
  std::int64_t evaluations_ = 0;
  GeneticEffort genetic_;
  std::vector<double> times_ms_;
};

/// A row of the tables.
struct MatchCandidate {
  std::string name;
  /// A single matcher, or one of each MatcherKind in their order: then each case names the one to use.
  std::vector<std::shared_ptr<const Matcher>> matchers;
};

enum class CandidateSet {
  kAll,       ///< with all ablations
  kMatchers,  ///< csm, csm_ga, ga and ga_paper
};

/// The first candidate is exact CSM, with which the others are compared.
std::vector<MatchCandidate> match_candidates(CandidateSet set, const MapperOptions& options);

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
/// "local_maps". A rate without cases is null. CSV has the rows of all series. The plots show the mean time
/// over the half-width of the window and over the size of the local maps.
BenchReport match_report(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                         const std::string& machine);

}  // namespace psi_slam
