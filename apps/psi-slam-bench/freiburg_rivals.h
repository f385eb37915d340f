// SPDX-License-Identifier: BSD-3-Clause
// The rivals that were run here, for the benchmark's page and its JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "freiburg_benchmark.h"

namespace psi_slam {

/// A section of its own; empty where no rivals were asked for.
std::string rivals_markdown(const FreiburgBenchmark& benchmark);

///     {"programs": [{"rival": "icp-slam", "version": "...", "sha256": "...", "config": "...", "changes":
///       "..."}],
///      "missing": ["rbpf-slam is not on PATH"],
///      "runs": [{"log": "intel", "rival": "icp-slam", "figures": {...}}, {..., "not_finished_in_s": 600},
///       {..., "failure": "..."}]}
nlohmann::ordered_json rivals_json(const FreiburgBenchmark& benchmark);

}  // namespace psi_slam
