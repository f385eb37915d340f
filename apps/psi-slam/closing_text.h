// SPDX-License-Identifier: BSD-3-Clause
// What a run tells its user at the end.
#pragma once

#include <cstddef>
#include <string>

#include "psi_slam/mapping_result.h"
#include "report/output_folder.h"
#include "exports/run_summary.h"

namespace psi_slam {

/// Where the map is, and the run's figures, in a few lines.
std::string closing_text(const RunSummary& summary, const std::string& log_name, const OutputFolder& folder);

/// Sentences for a run that does not map all of its log: a person has interrupted it, or `why` the log
/// breaks off.
std::string interrupted_text(std::size_t scans);
std::string broken_off_text(const std::string& why, std::size_t scans);

/// How long each stage took, a line each: calls, mean ± std [min, max] and sum.
std::string stages_text(const MappingResult& result);

}  // namespace psi_slam
