// SPDX-License-Identifier: BSD-3-Clause
// The Freiburg benchmark: every log mapped with every matcher and every seed, each run in a process of its
// own so that its times and its memory are its own. What a run came to is kept in a small file, and a run
// whose file is there is not made again as long as its log, its relations, its settings and the program are
// the same.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"
#include "freiburg/freiburg_run.h"
#include "common/log_identity.h"
#include "batch/child_workers.h"
#include "batch/seed_range.h"
#include "freiburg/baseline_program.h"
#include "freiburg/baseline_run.h"

namespace psi_slam {

struct FreiburgOptions {
  std::vector<std::string> matchers = freiburg_matchers();
  SeedRange seeds{1, 10};        ///< a matcher that draws no random numbers runs once, with the first
  int processes = 1;             ///< at a time
  int threads = 1;               ///< of each
  std::filesystem::path output;  ///< the runs' files are output/runs/LOG-MATCHER-SEED.json
  std::filesystem::path program = "/proc/self/exe";  ///< psi-slam-bench, which does the runs
  ChildWorkers workers{};                            ///< none: `processes` on this machine
};

struct FreiburgResult {
  std::uint64_t seed = 1;
  std::optional<FreiburgFigures> figures;
  std::string failure;  ///< why there are none
  bool made = false;    ///< now; else its file was there
};

/// One log with one matcher.
struct FreiburgCell {
  std::string log;
  std::string matcher;
  std::vector<FreiburgResult> runs;  ///< by seed
};

struct FreiburgBenchmark {
  std::vector<LogIdentity> logs;
  std::vector<FreiburgCell> cells;             ///< by log, then in the order of the matchers
  std::vector<std::string> without_relations;  ///< logs of the folder that cannot be evaluated
  std::vector<std::string> left_out;           ///< logs of the folder that were not asked for
  FoundBaselines baselines;                          ///< mappers of others, where they were asked for
  std::vector<BaselineResult> baseline_results;      ///< of run_baselines()
};

/// Makes the runs that are not there yet. `logs` need their relations. A run that fails does not stop the
/// others. Once `stop` is true no more are begun and those under way are ended; then, and when a file cannot
/// be written, throws SystemFailure; what was finished stays. `progress` takes what is being done and how
/// much of all is done; it is called by several threads, one at a time.
FreiburgBenchmark run_freiburg_benchmark(
    const std::vector<BenchmarkLog>& logs, const FreiburgOptions& options, const std::atomic<bool>& stop,
    const std::function<void(const std::string&, double, double)>& progress);

}  // namespace psi_slam
