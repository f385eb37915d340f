// SPDX-License-Identifier: BSD-3-Clause
// The baselines that were run here, for the benchmark's page and its JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "freiburg/freiburg_benchmark.h"

namespace psi_slam {

/// A section of its own; empty where no baselines were asked for.
std::string baselines_markdown(const FreiburgBenchmark& benchmark);

///     {"programs": [{"rival": "icp-slam", "version": "...", "sha256": "...", "config": "...", "changes":
///       "..."}],
///      "missing": ["rbpf-slam is not on PATH"],
///      "runs": [{"log": "intel", "rival": "icp-slam", "figures": {...}}, {..., "not_finished_in_s": 600},
///       {..., "failure": "..."}]}
nlohmann::ordered_json baselines_json(const FreiburgBenchmark& benchmark);

}  // namespace psi_slam
