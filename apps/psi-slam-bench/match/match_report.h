// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/bench_report.h"
#include "match/match_benchmark.h"

namespace psi_slam {

/// The report of the `match` command. JSON has the rows of the single scans as "matchers", and those of scans
/// with their context as "context", over window sizes as "windows" and over sizes of local maps as
/// "local_maps". A rate without cases is null. CSV has the rows of all series.
BenchReport match_report(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                         const std::string& machine);

/// Plots of the mean time as SVG: over the half-width of the window, and over the size of the local maps.
std::string window_plot(const MatchBenchmark& benchmark);
std::string local_map_plot(const MatchBenchmark& benchmark);

}  // namespace psi_slam
