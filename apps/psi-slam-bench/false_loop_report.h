// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of false loops for people (Markdown, SVG) and for programs (JSON).
#pragma once

#include <string>

#include "false_loop_benchmark.h"

namespace psi_slam {

std::string false_loop_markdown(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                                const std::string& machine);

///     {"schema": "psi-slam-false-loops", "logs": [...], "rows": [{"log": "aces", "kind": "scattered",
///       "share_percent": 10, "true_loops": 100, "false_loops": 10, "undefended":
///       {"translation_error_m": 1.2, "rotation_error_deg": 3.4, "false_kept": 10, "true_lost": 0, "time_ms":
///       5}, "worst_first": {...}, "defended": {...}, "from_map": {...}}, ...]}
std::string false_loop_json(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                            const std::string& machine);

/// Error against the share of false loops of one kind: a line for each log, and a thin one without the
/// defence.
std::string false_loop_plot(const FalseLoopBenchmark& benchmark, FalseLoopKind kind);

}  // namespace psi_slam
