// SPDX-License-Identifier: BSD-3-Clause
// Every baseline that is installed here on every log, each run in a process of its own. What one came to is kept
// and not made again as long as the log, its relations, how it is read, the baseline and its settings are the
// same; one that did not finish is tried again only with more time.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"
#include "batch/task_progress.h"
#include "freiburg/baseline_program.h"
#include "freiburg/baseline_run.h"

namespace psi_slam {

struct BaselineOptions {
  double time_limit_s = 600;  ///< of each run
  int processes = 1;          ///< at a time
  std::filesystem::path
      output;  ///< what is kept is output/runs/LOG-RIVAL.json, the rest output/baselines/LOG-RIVAL
};

/// Results by log, then baseline. `logs` need their relations. Once `stop` is true no more runs are begun and
/// those under way are ended; then, and when a file cannot be written, throws SystemFailure.
std::vector<BaselineResult> run_baselines(const std::vector<BaselineProgram>& baselines,
                                    const std::vector<BenchmarkLog>& logs, const BaselineOptions& options,
                                    const std::atomic<bool>& stop, const TaskProgress::Observer& observer);

}  // namespace psi_slam
