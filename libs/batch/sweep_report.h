// SPDX-License-Identifier: BSD-3-Clause
// Report files of a finished or interrupted sweep. Apart from times and memory, the reports do not depend on
// interruptions or on the workers that made the runs.
#pragma once

#include <filesystem>
#include <string>

#include "batch/sweep.h"

namespace psi_slam {

/// CSV with a line for each run. Times and memory are the last columns.
std::string sweep_csv(const SweepPlan& plan, const SweepResult& result);

/// JSON with all runs, the checksums of the logs, the keys of the runs and all errors.
std::string sweep_json(const SweepPlan& plan, const SweepResult& result);

/// Tables of errors and loops, failed runs, times and memory. A row holds the statistics over the seeds for
/// one log and one setting. The smallest error of each log is marked.
std::string sweep_markdown(const SweepPlan& plan, const SweepResult& result);
std::string sweep_html(const SweepPlan& plan, const SweepResult& result);

/// Writes sweep.csv, sweep.json, report.md and report.html. Throws SystemFailure when a file cannot be
/// written.
void write_sweep_report(const SweepPlan& plan, const SweepResult& result,
                        const std::filesystem::path& folder);

}  // namespace psi_slam
