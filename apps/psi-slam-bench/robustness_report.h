// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of degraded logs for people (Markdown, SVG) and for programs (JSON).
#pragma once

#include <string>
#include <vector>

#include "robustness_benchmark.h"

namespace psi_slam {

std::string robustness_markdown(const RobustnessBenchmark& benchmark, std::uint64_t seed,
                                const std::string& machine);

///     {"schema": "psi-slam-robustness", "logs": [{"name": "aces", "natural_odometry_noise": {...}}, ...],
///      "rows": [{"log": "aces", "series": "scans kept", "case": "1 of 2", "translation_error_m": 0.04,
///       "rotation_error_deg": 0.4, "relations": 100, "scans": 3600, "unmatched_scans": 2, "loops": 1000,
///       "loop_precision": 1, "loop_recall": 0.9}, ...]}
///
/// A precision or recall of nothing is null.
std::string robustness_json(const RobustnessBenchmark& benchmark, std::uint64_t seed,
                            const std::string& machine);

struct RobustnessPlot {
  std::string series;  ///< "odometry noise"
  std::string file;    ///< "robustness-odometry-noise.svg"
  std::string svg;     ///< the error of each log
};
std::vector<RobustnessPlot> robustness_plots(const RobustnessBenchmark& benchmark);

}  // namespace psi_slam
