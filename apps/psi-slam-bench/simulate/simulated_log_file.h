// SPDX-License-Identifier: BSD-3-Clause
// A simulated drive as a log file, with its truth beside it.
#pragma once

#include <filesystem>

#include "simulation/simulated_log.h"

namespace psi_slam {

/// Throws UserError when `log` is not named NAME.clf.gz or cannot be written.
void check_simulated_log_file(const std::filesystem::path& log);

/// Writes the drive as a gzipped CARMEN log NAME.clf.gz, with the true poses as those of the map; beside it
/// NAME.relations, true relations between random pairs of scans, and NAME.tum, the true path. Throws
/// SystemFailure when they cannot be written.
void write_simulated_log(const std::filesystem::path& log, const SimulatedLogOptions& drive);

}  // namespace psi_slam
