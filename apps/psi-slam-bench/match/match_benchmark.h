// SPDX-License-Identifier: BSD-3-Clause
// Compares the matchers, each genetic one with both genetic searches. Runs every candidate on every case.
#pragma once

#include <array>
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

/// Largest errors of a successful match: distance and angle between its pose and the true pose.
inline constexpr double kSuccess_m = 0.3;
inline constexpr double kSuccess_rad = radians_from_degrees(3.5L);

struct Judgement {
  bool success = false;       ///< positive cases: found within the limits above
  bool same_optimum = false;  ///< positive cases: response not below exact CSM's, or no match by either
  bool false_accept = false;  ///< negative cases: found with a response that loop closing would accept
};

/// Judges a match. `exact` is the match of exact CSM in the same case. `accepted_response` is the least
/// response that loop closing accepts.
Judgement judge(const LoopCase& loop_case, const MatchResult& match, const MatchResult& exact,
                double accepted_response);

struct TimeFigures {
  double mean = 0;
  double p50 = 0;
  double p95 = 0;
  double p99 = 0;
  double max = 0;
};

struct MatchFigures {
  std::size_t cases = 0;
  std::size_t positive = 0;
  std::size_t negative = 0;
  std::optional<double> success_rate;       ///< share of the positive cases; empty without positive cases
  std::optional<double> same_optimum_rate;  ///< share of the positive cases; empty without positive cases
  std::optional<double> false_accept_rate;  ///< share of the negative cases; empty without negative cases
  /// Number of cases by the search that the matcher ran, in the order of kSearchKinds.
  std::array<std::size_t, kSearchKinds.size()> searches{};
  double evaluations = 0;  ///< mean number of scored poses
  // Processor time of a match in milliseconds.
  TimeFigures time_ms;          ///< over all cases
  TimeFigures loop_time_ms;     ///< over the positive cases
  TimeFigures no_loop_time_ms;  ///< over the negative cases
};

/// Sums up the figures of a matcher over the cases.
class MatchTally {
 public:
  void add(const LoopCase& loop_case, const Judgement& judgement, const MatchResult& match, double time_ms);

  /// Figures of all cases so far. The percentile p of n values has the rank floor(p n / 100), counted from 0.
  MatchFigures figures() const;

 private:
  std::size_t successes_ = 0;
  std::size_t same_optima_ = 0;
  std::size_t false_accepts_ = 0;
  std::array<std::size_t, kSearchKinds.size()> searches_{};
  std::int64_t evaluations_ = 0;
  std::vector<double> loop_times_ms_;     // one for each positive case
  std::vector<double> no_loop_times_ms_;  // one for each negative case
};

/// A matcher to compare: one row of a table.
struct MatchCandidate {
  std::string name;
  std::shared_ptr<const Matcher> matcher;
};

/// Makes the candidates: csm, csm_ga and ga, then the last two with the genetic search of the paper. The
/// first is exact CSM, with which all others are compared.
std::vector<MatchCandidate> match_candidates(const MapperOptions& options);

/// Cases of one kind, drawn from every log: one table of the report.
struct MatchSeries {
  std::string title;
  CaseOptions cases;

  struct Row {
    std::string matcher;
    MatchTally tally;
  };
  std::vector<Row> rows;  ///< one for each candidate, over the cases run so far; the first is exact CSM
};

/// Names of the parts of the benchmark, as the option --parts takes them.
inline constexpr const char* kScansPart = "scans";
inline constexpr const char* kContextsPart = "contexts";
inline constexpr const char* kWindowsPart = "windows";  ///< scans and contexts over sizes of the window

struct MatchBenchmarkOptions {
  std::size_t cases = 250;  ///< number of positive cases from each log, and of negative cases
  std::uint64_t seed = 1;
  std::vector<std::string> parts = {kScansPart, kContextsPart};

  bool has(const char* part) const;
};

/// Use of a log in the benchmark.
struct LogNote {
  std::string name;
  std::string md5;  ///< checksum of the log file
  std::optional<double> translation_error_m;
  std::size_t positive = 0;  ///< number of positive cases in the first series
  std::size_t negative = 0;
  std::string remark;  ///< reason for leaving the log out, or missing cases; may be empty
  bool used = true;
};

struct MatchBenchmark {
  std::vector<LogNote> logs;
  MatchSeries scans;                 ///< without rows if the part was not run
  MatchSeries contexts;              ///< without rows if the part was not run
  std::vector<MatchSeries> windows;  ///< one for each size of the window, see plan_windows(); may be empty
};

/// The series over sizes of the window: single scans, then scans with their context; for each of them windows
/// of ±30°, then of ±180°, in ascending order of their half-widths. All have the same pairs of scan and local
/// map. They have a fifth of the cases of the other series.
std::vector<MatchSeries> plan_windows(const MatchBenchmarkOptions& options);

/// Largest mean error over the relations, in metres, of a map whose poses serve as truth.
inline constexpr double kTrustedError_m = 0.2;

/// Runs every candidate on every case in this thread, case by case, and adds the results to the rows of the
/// series. Calls `after_case` after each case.
void run_cases(const std::vector<LoopCase>& cases, const std::vector<MatchCandidate>& candidates,
               double accepted_response, MatchSeries& series, const std::function<void()>& after_case);

/// Maps each log, draws its cases and runs them. Throws UserError when no log can be used.
MatchBenchmark run_match_benchmark(const std::vector<BenchmarkLog>& logs,
                                   const MatchBenchmarkOptions& options, const ProgressObserver& observer);

/// The report of the `match` command. JSON has the rows of the single scans as "matchers", and those of scans
/// with their context as "context" and over window sizes as "windows". A rate without cases is null. CSV has
/// the rows of all series. The plots show the mean time over the half-width of the window.
BenchReport match_report(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                         const std::string& machine);

}  // namespace psi_slam
