// SPDX-License-Identifier: BSD-3-Clause
// The Freiburg benchmark for people (Markdown) and for programs (JSON).
#pragma once

#include <string>

#include "freiburg/freiburg_benchmark.h"

namespace psi_slam {

/// The page: how it was measured, ours beside the others, every matcher on every log, the logs' checksums.
std::string freiburg_markdown(const FreiburgBenchmark& benchmark, const FreiburgOptions& options,
                              const std::string& machine);

///     {"schema": "psi-slam-freiburg-benchmark", "cells": [{"log": "intel", "matcher": "ga", "runs": 10,
///       "failed": [{"seed": 3, "reason": "..."}],
///       "translation_abs_m": {"mean": 0.02, "std": 0.01, "over_seeds": {"std": 0, "min": 0.02, "max":
///       0.02}},
///       ..., "wall_s": {"mean": ..., "std": ..., "min": ..., "max": ...}, ...}],
///      "comparison": [{"log": "Intel", "figure": "translation_abs_m",
///       "systems": [{"system": "Cartographer", "mean": ..., "std": ..., "best": false}]}], ...}
std::string freiburg_json(const FreiburgBenchmark& benchmark, const FreiburgOptions& options,
                          const std::string& machine);

}  // namespace psi_slam
