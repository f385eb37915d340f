// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/bench_report.h"
#include "false_loops/false_loop_benchmark.h"

namespace psi_slam {

/// The report of the `false-loops` command. In JSON, each element of "rows" has the statistics over the seeds
/// of each treatment: "undefended", "worst_first", "defended" and "from_map". Each kind of false loops has a
/// plot.
BenchReport false_loop_report(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                              const std::string& machine);

/// Plot of the error over the share of false loops of one kind, as SVG: a line for each log with bars from
/// the least to the greatest error of the seeds, and a thin line without the defence.
std::string false_loop_plot(const FalseLoopBenchmark& benchmark, FalseLoopKind kind);

}  // namespace psi_slam
