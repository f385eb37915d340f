// SPDX-License-Identifier: BSD-3-Clause
// The report's figures: tiles, tables and lists, as HTML.
#pragma once

#include <string>

#include "psi_slam/mapping_result.h"
#include "exports/run_summary.h"

namespace psi_slam {

std::string key_figures(const RunSummary& summary);
std::string log_table(const MappedLogFacts& log, const std::string& name);
std::string reasons_table(const LoopCounts& loops);
std::string stages_table(const std::vector<StageTiming>& stages, double wall_s);

/// What each matcher did to close loops; empty where none was used.
std::string loop_matchers_table(const MappingResult& result);

/// The first loops of each verdict, folded away; loops.csv has them all.
std::string loops_table(const MappingResult& result);

/// One table a section, folded away.
std::string settings_table(const std::map<std::string, std::string>& settings);

}  // namespace psi_slam
