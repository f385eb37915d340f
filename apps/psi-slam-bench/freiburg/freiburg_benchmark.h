// SPDX-License-Identifier: BSD-3-Clause
// The Freiburg benchmark: maps every log with every matcher and every seed. Each run has a process of its
// own, so that its time and memory can be measured. Results are kept in small files: a run is not repeated
// while its log, its relations, its settings and the program stay the same.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/child_process.h"
#include "batch/seeds.h"
#include "common/bench_report.h"
#include "common/benchmark_logs.h"
#include "freiburg/baseline_program.h"
#include "freiburg/baseline_run.h"
#include "freiburg/freiburg_run.h"

namespace psi_slam {

struct FreiburgOptions {
  std::vector<std::string> matchers = freiburg_matchers();
  SeedRange seeds{1, 10};        ///< a matcher without random numbers runs only with the first
  int processes = 1;             ///< runs at a time
  int threads = 1;               ///< of each run
  std::filesystem::path output;  ///< results are kept in output/runs/LOG-MATCHER-SEED.json
  std::filesystem::path program = "/proc/self/exe";  ///< psi-slam-bench, which makes the runs
  ChildWorkers workers{};                            ///< empty: `processes` on this machine
};

struct FreiburgResult {
  std::uint64_t seed = 1;
  std::optional<FreiburgFigures> figures;
  std::string failure;  ///< reason for missing figures
  bool made = false;    ///< now; otherwise kept from before
};

/// One log with one matcher.
struct FreiburgCell {
  std::string log;
  std::string matcher;
  std::vector<FreiburgResult> runs;  ///< by seed
};

struct FreiburgBenchmark {
  std::vector<LogIdentity> logs;
  std::vector<FreiburgCell> cells;             ///< by log, then matcher
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<std::string> left_out;           ///< logs that --logs does not name
  FoundBaselines baselines;                    ///< empty without --baselines
  std::vector<BaselineResult> baseline_results;
};

/// Makes the runs that have no kept results. All `logs` need relations. A run that fails does not stop the
/// others. When `stop` becomes true, ends the running processes and throws SystemFailure; finished results
/// are kept. Also throws SystemFailure when a file cannot be written. Calls `progress` from several threads,
/// one at a time.
FreiburgBenchmark run_freiburg_benchmark(const std::vector<BenchmarkLog>& logs,
                                         const FreiburgOptions& options, const std::atomic<bool>& stop,
                                         const ProgressObserver& progress);

}  // namespace psi_slam
