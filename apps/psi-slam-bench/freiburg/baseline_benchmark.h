// SPDX-License-Identifier: BSD-3-Clause
// Runs every installed baseline on every log, each run in a process of its own. A result is kept and not
// repeated while the log, its relations, the settings of its reader, the baseline and its settings stay the
// same. A run that did not finish is repeated only with a larger time limit.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "batch/workers.h"
#include "freiburg/baseline_run.h"

namespace psi_slam {

struct BaselineOptions {
  double time_limit_s = 600;     ///< of each run
  int processes = 1;             ///< runs at a time
  std::filesystem::path output;  ///< for runs/LOG-BASELINE.json, and for the files of the runs
};

/// Results by log, then baseline. All `logs` need relations. When `stop` becomes true, ends the running
/// processes and throws SystemFailure. Also throws SystemFailure when a file cannot be written.
std::vector<BaselineResult> run_baselines(const std::vector<BaselineProgram>& baselines,
                                          const std::vector<BenchmarkLog>& logs,
                                          const BaselineOptions& options, const std::atomic<bool>& stop,
                                          const ProgressObserver& observer);

}  // namespace psi_slam
