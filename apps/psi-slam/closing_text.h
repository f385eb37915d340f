// SPDX-License-Identifier: BSD-3-Clause
// Texts that a run prints at its end.
#pragma once

#include <cstddef>
#include <string>

#include "exports/run_summary.h"
#include "psi_slam/mapping_result.h"
#include "report/output_folder.h"

namespace psi_slam {

/// Path of the map and the main figures of the run, in a few lines.
std::string closing_text(const RunSummary& summary, const std::string& log_name, const OutputFolder& folder);

/// Sentences for a run that was interrupted, and for a log with damage `why`.
std::string interrupted_text(std::size_t scans);
std::string broken_off_text(const std::string& why, std::size_t scans);

/// Times of each stage, a line each: calls, mean ± std [min, max] and sum.
std::string stages_text(const MappingResult& result);

}  // namespace psi_slam
