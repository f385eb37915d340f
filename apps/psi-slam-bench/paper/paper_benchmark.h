// SPDX-License-Identifier: BSD-3-Clause
// The experiment of the paper (section 4). Maps logs with fixed search windows, one thread and one scan at a
// time. Compares exact search, the genetic search, and the switch between them by the factor Psi. Each search
// for loops has a deadline of one scan period.
//
// As in the paper, a single scan is matched with each local map nearby, and loops are found only while the
// log is read. The front end, the verification of loops and the optimisation are those of psi-slam.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "batch/run_figures.h"
#include "batch/workers.h"
#include "common/bench_report.h"
#include "common/measured_map.h"
#include "session/settings.h"
#include "sparse/sparse_logs.h"

namespace psi_slam {

/// A way to choose the matcher of loops: one row of the table for each log.
struct PaperCandidate {
  std::string name;                      ///< "csm", "ga_paper", "ga", "switch_paper" or "switch"
  std::string meaning;                   ///< description as a clause
  std::vector<std::string> assignments;  ///< settings "section.key=value"
};
const std::vector<PaperCandidate>& paper_candidates();

struct PaperOptions {
  std::vector<std::string> matchers;  ///< names of candidates; empty: all
  std::uint64_t seed = 1;             ///< seed of the genetic searches

  /// The candidates that `matchers` names.
  std::vector<PaperCandidate> candidates() const;
};

/// Settings of a run: fixed windows of the paper's size, and the settings of log and candidate. Throws
/// UserError as benchmark_settings().
Settings paper_settings(const BenchmarkLog& log, const PaperCandidate& candidate, std::uint64_t seed);

/// Times of the back end over the scans that searched for loops.
struct BackEndTimes {
  std::size_t searches = 0;         ///< number of scans that searched for loops
  std::size_t deadline_misses = 0;  ///< searches that took longer than one scan period
  double p50_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
};

/// Median time between successive scans, in milliseconds; 0 with fewer than two scans.
double scan_period_ms(const std::vector<FrameRecord>& frames);

/// Times of loop closing and optimisation. A time is the smaller of two upper bounds of the processor time of
/// the back end: its wall time, and the processor time `add_ms` of the whole scan. Other programs on the
/// machine increase only the wall time.
BackEndTimes back_end_times(const std::vector<FrameRecord>& frames, const std::vector<double>& add_ms,
                            double period_ms);

/// Figures of one run.
struct PaperRow {
  std::string log;
  std::string matcher;           ///< name of the candidate
  RunFigures figures;            ///< memory is not measured
  std::size_t loops = 0;         ///< accepted loops in the finished graph
  std::size_t loops_judged = 0;  ///< accepted loops that a relation can judge, see loop_judgement.h
  std::size_t loops_false = 0;   ///< judged loops that contradict a relation
  std::size_t windows = 0;       ///< number of windows searched
  std::array<std::size_t, kSearchKinds.size()> searches{};  ///< `windows` by the search that ran
  double period_ms = 0;                                     ///< see scan_period_ms()
  BackEndTimes times;
};

struct PaperBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<PaperRow> rows;                  ///< ordered by log, then candidate
};

/// Maps each log with each candidate. Throws UserError as open_log() and read_relations().
PaperBenchmark run_paper_benchmark(const SparseLogs& logs, const PaperOptions& options,
                                   const ProgressObserver& observer);

/// The report of the `paper` command. In JSON, "rows" has a row for each run. The page has the errors beside
/// the paper's tables 1 and 2.
BenchReport paper_report(const PaperBenchmark& benchmark, const PaperOptions& options,
                         const std::string& machine);

}  // namespace psi_slam
