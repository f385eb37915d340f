// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of scale for people (Markdown, plots) and for programs (JSON).
#pragma once

#include <string>
#include <vector>

#include "simulate/simulate_benchmark.h"

namespace psi_slam {

/// "500 m", "10 km".
std::string metres_text(double metres);

std::string simulate_markdown(const std::vector<SimulateRow>& rows, const SimulateOptions& options,
                              const std::string& machine);

/// {"schema": "psi-slam-simulate-benchmark", ..., "drives": [{"path_m": 500.1, "scans": 5000, ...}, ...]}
std::string simulate_json(const std::vector<SimulateRow>& rows, const SimulateOptions& options,
                          const std::string& machine);

/// A row as an object of "drives", and back again, exactly.
std::string row_json_text(const SimulateRow& row);
SimulateRow row_of_json(const std::string& text);

/// How they grow with the length of the path, SVG.
std::string error_plot(const std::vector<SimulateRow>& rows);
std::string time_plot(const std::vector<SimulateRow>& rows);
std::string memory_plot(const std::vector<SimulateRow>& rows);

}  // namespace psi_slam
