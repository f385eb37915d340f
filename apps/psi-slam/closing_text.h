// SPDX-License-Identifier: BSD-3-Clause
// Texts that a run prints at its end.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "map/exports/run_summary.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Path of the map and the main figures of the run, in a few lines, with the verdict unless the map is
/// broken.
std::string closing_text(const RunSummary& summary, const std::string& log_name, const OutputFolder& folder);

/// Warning about a map that the verdict finds broken: the worst place and what would help. Empty for other
/// maps.
std::optional<std::string> broken_map_text(const RunSummary& summary);

/// Sentence about a run that the user interrupted after `scans` scans.
std::string interrupted_text(std::size_t scans);

/// Sentence about a run that ended after `scans` scans at a damaged place of the log; `why` describes the
/// damage.
std::string broken_off_text(const std::string& why, std::size_t scans);

/// Times of the stages, one line each: number of calls, mean ± standard deviation [min, max] in ms, and sum
/// in s.
std::string stages_text(const MappingResult& result);

}  // namespace psi_slam
