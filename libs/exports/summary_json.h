// SPDX-License-Identifier: BSD-3-Clause
// summary.json: the figures of a run for programs. Its schema is versioned: "schema" is "psi-slam-summary"
// and "schema_version" grows by one when a key is renamed or removed, not when one is added. Units are in the
// keys.
#pragma once

#include <filesystem>
#include <string>

#include "psi_slam/mapping_result.h"
#include "exports/run_summary.h"

namespace psi_slam {

inline constexpr int kSummarySchemaVersion = 1;

/// The summary as JSON text with a line end. (Each single loop is in loops.csv, each scan in frames.csv.)
/// Figures that are not finite become null.
std::string summary_json(const MappingResult& result, const RunInfo& info, const RunSummary& summary);

}  // namespace psi_slam
