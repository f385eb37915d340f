// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "common/bench_report.h"
#include "simulate/simulate_benchmark.h"

namespace psi_slam {

/// "500 m", "10 km".
std::string metres_text(double metres);

/// The report of the `simulate` command. JSON has an object for each run in "drives". The plots show how
/// error, time and memory grow with the length of the path.
BenchReport simulate_report(const std::vector<SimulateRow>& rows, const SimulateOptions& options,
                            const std::string& machine);

/// The floor plan with the true path of the robot, as SVG.
std::string plan_svg(const FloorPlan& plan, const Trajectory& truth);

}  // namespace psi_slam
