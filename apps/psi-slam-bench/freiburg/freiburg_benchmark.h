// SPDX-License-Identifier: BSD-3-Clause
// The Freiburg benchmark: maps every log with every matcher and every seed, and measures the errors of the
// paths over relations (R. Kümmerle et al., "On measuring the accuracy of SLAM algorithms", 2009). Each run
// has a process of its own, so that its time and memory can be measured. Results are kept in small files. A
// run is not repeated while log, relations, settings, program and machine stay the same.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/child_process.h"
#include "batch/run_figures.h"
#include "batch/seeds.h"
#include "common/bench_report.h"
#include "freiburg/baselines.h"
#include "session/settings.h"

namespace psi_slam {

/// One run: maps a log once with one matcher and one seed.
struct FreiburgRun {
  std::filesystem::path log;
  std::filesystem::path ini;
  std::filesystem::path relations;
  std::string matcher;  ///< one of freiburg_matchers()
  std::uint64_t seed = 1;
  int threads = 1;
};

/// Names of the matchers: the values "csm", "csm_ga", "ga" and "adaptive" of loop_closure.matcher, and
/// "adaptive_paper", the paper's switch (see paper_switch_settings()) with the genetic search of the paper.
const std::vector<std::string>& freiburg_matchers();

/// True for all matchers except csm, whose search is exact. No other part of a run draws random numbers.
bool draws_random_numbers(const std::string& matcher);

/// The default settings, overridden by the settings of the log, then by matcher, seed and threads of the run.
/// Throws UserError as benchmark_settings().
Settings settings_of(const FreiburgRun& run);

/// All settings, with a line "section.key = value" for each. Equal texts mean equal settings.
std::string settings_text(const Settings& settings);

struct FreiburgFigures : RunFigures {
  std::size_t loops_accepted = 0;
  std::size_t loops_judged = 0;       ///< accepted loops that a relation can judge, see loop_judgement.h
  std::size_t loops_false = 0;        ///< judged loops that contradict a relation
  std::optional<double> loop_recall;  ///< LoopJudgement::recall(); empty without relations between two passes
};

/// Maps the log and evaluates its path, without drawing a map or writing files. Throws UserError as
/// MappingSession and evaluate_relations(), and when the log ends early, because figures of a part of a log
/// are not comparable.
FreiburgFigures map_and_evaluate(const FreiburgRun& run);

/// The figures as one line of JSON, for read_figures().
std::string figures_json(const FreiburgFigures& figures);

/// Reads the text of figures_json(). Returns nothing for any other text.
std::optional<FreiburgFigures> read_figures(const std::string& json);

struct FreiburgOptions {
  std::vector<std::string> matchers = freiburg_matchers();
  SeedRange seeds{1, 10};        ///< a matcher without random numbers runs only with the first seed
  int processes = 1;             ///< number of runs at a time
  int threads = 1;               ///< number of threads of each run
  std::filesystem::path output;  ///< results are kept in output/runs/LOG-MATCHER-SEED.json
  std::filesystem::path program = "/proc/self/exe";  ///< psi-slam-bench, which makes the runs
};

struct FreiburgResult {
  std::uint64_t seed = 1;
  std::optional<FreiburgFigures> figures;
  std::string failure;  ///< reason for missing figures
  bool made = false;    ///< true: the run was made now; false: its result was kept from before
};

/// Runs of one log with one matcher.
struct FreiburgCell {
  std::string log;
  std::string matcher;
  std::vector<FreiburgResult> runs;  ///< ordered by seed
};

/// Figures of one log with one matcher over all seeds: means and spreads, not the best run.
struct CellFigures {
  std::size_t runs = 0;    ///< successful runs
  std::size_t failed = 0;  ///< failed runs
  PathErrors errors;       ///< means and standard deviations of the runs, averaged over the seeds
  /// Spread of the mean errors over the seeds, in the order of kPathFigures.
  std::array<SeedSpread, kPathFigures.size()> spread;
  double relations_used = 0;  ///< mean over the seeds
  double relations_skipped = 0;
  SeedSpread loops_accepted;
  SeedSpread loops_judged;
  SeedSpread loops_false;
  std::optional<SeedSpread> loop_recall;  ///< spread over the runs with a recall; empty without such runs
  SeedSpread wall_s;
  SeedSpread cpu_s;
  SeedSpread real_time_factor;
  SeedSpread peak_memory_mib;
};

/// Figures over the successful runs of a cell; empty if every run failed.
std::optional<CellFigures> figures_of(const FreiburgCell& cell);

struct FreiburgBenchmark {
  std::vector<LogIdentity> logs;
  std::vector<FreiburgCell> cells;             ///< ordered by log, then matcher
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<std::string> left_out;           ///< logs that --logs does not name
  FoundBaselines baselines;                    ///< empty without --baselines
  std::vector<BaselineResult> baseline_results;
};

/// Makes the runs that have no kept results. All `logs` need relations. After a failed run, goes on with the
/// next run. When `stop` becomes true, ends the running processes and throws SystemFailure; finished results
/// are kept. Also throws SystemFailure when a file cannot be written. Calls `progress` from several threads,
/// one at a time.
FreiburgBenchmark run_freiburg_benchmark(const std::vector<BenchmarkLog>& logs,
                                         const FreiburgOptions& options, const std::atomic<bool>& stop,
                                         const ProgressObserver& progress);

/// The report of the `freiburg` command: psi-slam compared with published systems and baselines, every
/// matcher on every log, and the checksums of the logs. Each log has a plot. In JSON, "cells" has the
/// statistics over the seeds of each matcher on each log, "comparison" has the systems for each error of each
/// log, and "rivals" has the baselines:
///
///     {"programs": [{"rival": "icp-slam", "version": "...", "sha256": "...", "config": "...", "changes":
///       "..."}],
///      "missing": ["rbpf-slam is not on PATH"],
///      "runs": [{"log": "intel", "rival": "icp-slam", "figures": {...}}, {..., "not_finished_in_s": 600},
///       {..., "failure": "..."}]}
BenchReport freiburg_report(const FreiburgBenchmark& benchmark, const FreiburgOptions& options,
                            const std::string& machine);

}  // namespace psi_slam
