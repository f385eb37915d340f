// SPDX-License-Identifier: BSD-3-Clause
// Writes a simulated run as a log file with its truth, and draws its floor plan.
#pragma once

#include <filesystem>
#include <string>

#include "map/trajectory/trajectory_file.h"
#include "simulation/simulated_log.h"

namespace psi_slam {

/// Throws UserError if `log` is not named NAME.clf.gz or cannot be written.
void check_simulated_log_file(const std::filesystem::path& log);

/// Writes the run as a gzipped CARMEN log NAME.clf.gz with the true poses as corrected poses. Also writes
/// NAME.relations, the relations of random pairs of scans, and NAME.tum, the true path in TUM format. Throws
/// SystemFailure when a file cannot be written.
void write_simulated_log(const std::filesystem::path& log, const SimulatedLogOptions& run);

/// The floor plan with the true path of the robot, as SVG.
std::string plan_svg(const FloorPlan& plan, const Trajectory& truth);

}  // namespace psi_slam
