// SPDX-License-Identifier: BSD-3-Clause
// What a run tells its user at the end.
#pragma once

#include <string>

#include "psi_slam/mapping/mapping_result.h"
#include "psi_slam/results/output_folder.h"
#include "psi_slam/results/run_summary.h"

namespace psi_slam {

/// Where the map is, and the run's figures, in a few lines.
std::string closing_text(const RunSummary& summary, const std::string& log_name, const OutputFolder& folder);

/// How long each stage took, a line each: calls, mean ± std [min, max] and sum.
std::string stages_text(const MappingResult& result);

}  // namespace psi_slam
