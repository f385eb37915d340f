// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of degraded logs for people (Markdown, SVG) and for programs (JSON).
#pragma once

#include <string>
#include <vector>

#include "robustness/robustness_benchmark.h"

namespace psi_slam {

std::string robustness_markdown(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                                const std::string& machine);

///     {"schema": "psi-slam-robustness", "logs": [{"name": "aces", "natural_odometry_noise": {...}}, ...],
///      "rows": [{"log": "aces", "series": "scans kept", "case": "1 of 2", "seeds": [1],
///       "translation_error_m": {"mean": 0.04, "std": 0, "min": 0.04, "max": 0.04}, "rotation_error_deg":
///       {...}, "relations": {...}, "scans": {...}, "unmatched_scans": {...}, "loops": {...},
///       "loop_precision": {...}, "loop_recall": {...}}, ...]}
///
/// A precision or recall of nothing is null.
std::string robustness_json(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                            const std::string& machine);

struct RobustnessPlot {
  std::string series;  ///< "odometry noise"
  std::string file;    ///< "robustness-odometry-noise.svg"
  std::string svg;     ///< the error of each log, from the least to the greatest of the seeds
};
std::vector<RobustnessPlot> robustness_plots(const RobustnessBenchmark& benchmark);

}  // namespace psi_slam
