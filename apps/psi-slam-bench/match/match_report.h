// SPDX-License-Identifier: BSD-3-Clause
// The matcher benchmark for people (Markdown) and for programs (JSON).
#pragma once

#include <string>

#include "match/match_benchmark.h"

namespace psi_slam {

/// The page: where and how it was measured, and the tables.
std::string match_markdown(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                           const std::string& machine);

///     {"matchers": [{"matcher": "csm", "cases": 2500, "success_rate": 0.98, "same_optimum_rate": 1,
///       "false_accept_rate": 0.01, "evaluations": 12345.6,
///       "time_ms": {"mean": 1.2, "p50": 1, "p95": 2, "p99": 3}}, ...], ...}
///
/// for single scans, and more at the top level: the machine, the logs, the same rows for scans with their
/// context ("context"), over window sizes ("windows") and sizes of local maps ("local_maps"). A rate without
/// cases is null.
std::string match_json(const MatchBenchmark& benchmark, const MatchBenchmarkOptions& options,
                       const std::string& machine);

/// Plots of the mean time, SVG: against the window's half-width, and against the size of local maps.
std::string window_plot(const MatchBenchmark& benchmark);
std::string local_map_plot(const MatchBenchmark& benchmark);

}  // namespace psi_slam
