// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/bench_report.h"
#include "freiburg/freiburg_benchmark.h"

namespace psi_slam {

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
