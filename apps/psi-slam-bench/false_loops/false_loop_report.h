// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of false loops for people (Markdown, SVG) and for programs (JSON).
#pragma once

#include <string>

#include "false_loops/false_loop_benchmark.h"

namespace psi_slam {

std::string false_loop_markdown(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                                const std::string& machine);

///     {"schema": "psi-slam-false-loops", "logs": [...], "rows": [{"log": "aces", "kind": "scattered",
///       "share_percent": 10, "seeds": [1, 2], "true_loops": 100, "false_loops": 10, "undefended":
///       {"translation_error_m": {"mean": 1.2, "std": 0.1, "min": 1.1, "max": 1.3}, "rotation_error_deg":
///       {...}, "false_kept": {...}, "true_lost": {...}, "time_ms": {...}}, "worst_first": {...}, "defended":
///       {...}, "from_map": {...}}, ...]}
std::string false_loop_json(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                            const std::string& machine);

/// Error against the share of false loops of one kind: a line for each log, with bars from the least to
/// the greatest of the seeds, and a thin one without the defence.
std::string false_loop_plot(const FalseLoopBenchmark& benchmark, FalseLoopKind kind);

}  // namespace psi_slam
