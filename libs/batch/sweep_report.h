// SPDX-License-Identifier: BSD-3-Clause
// The files that a sweep leaves. They tell what the runs came to, not which of them were made now: whether a
// sweep was interrupted on the way, or who did the runs, changes nothing but times.
#pragma once

#include <filesystem>
#include <string>

#include "batch/sweep.h"

namespace psi_slam {

/// A row for each run; the times and the memory are the last columns.
std::string sweep_csv(const SweepPlan& plan, const SweepResult& result);

/// The same with the logs' checksums, the runs' keys and all errors.
std::string sweep_json(const SweepPlan& plan, const SweepResult& result);

/// The tables as a page.
std::string sweep_markdown(const SweepPlan& plan, const SweepResult& result);
std::string sweep_html(const SweepPlan& plan, const SweepResult& result);

/// Writes sweep.csv, sweep.json, report.md and report.html. Throws SystemFailure when it cannot.
void write_sweep_report(const SweepPlan& plan, const SweepResult& result,
                        const std::filesystem::path& folder);

}  // namespace psi_slam
