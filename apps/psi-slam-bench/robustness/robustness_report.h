// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/bench_report.h"
#include "robustness/robustness_benchmark.h"

namespace psi_slam {

/// The report of the `robustness` command. In JSON, "logs" has the natural noise of each log's odometry, and
/// "rows" has the statistics over the seeds of each case: {"mean", "std", "min", "max"}. A precision or
/// recall without loops or relations is null. Each series has a plot of the error of each log.
BenchReport robustness_report(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                              const std::string& machine);

}  // namespace psi_slam
