// SPDX-License-Identifier: BSD-3-Clause
// The sections of report.html, each returned as HTML or inline SVG.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <map>
#include <string>
#include <vector>

#include "exports/run_summary.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

extern const char* const kReportLogo;    ///< SVG
extern const char* const kReportStyle;   ///< CSS of the page
extern const char* const kReportScript;  ///< zooms and moves the map; the page works without it

/// The map as an image, with layers that checkboxes show or hide without any script: trajectory coloured by
/// time, unmatched scans, odometry, path of the front end, and loops of each verdict.
std::string report_map(const MappingResult& result, const UnmatchedScans& unmatched,
                       const mrpt::maps::COccupancyGridMap2D& grid);

/// The front end's response over time: mean and range of each stretch, unmatched scans, and when loops were
/// closed.
std::string response_plot(const MappingResult& result, const UnmatchedScans& unmatched);
/// The stretches of unmatched scans, folded away; empty if there are none.
std::string unmatched_table(const UnmatchedScans& unmatched);
/// The factor Psi over time with its thresholds, logarithmic, and below it the matcher in use.
std::string psi_plot(const MappingResult& result);
/// The colours of the matchers that were used.
std::string psi_key(const MappingResult& result);
/// Time to match the loops of each node over the time of the log, logarithmic.
std::string loop_matching_plot(const MappingResult& result);
/// Processing time of each scan over the time of the log, logarithmic, with the time between two scans.
std::string work_plot(const MappingResult& result);

/// Tiles with the main figures of the run.
std::string key_figures(const RunSummary& summary);
/// The input log.
std::string log_table(const MappedLogFacts& log, const std::string& name);
/// Why loops were refused or switched off, and how often.
std::string reasons_table(const LoopCounts& loops);
/// Time spent in each stage, also as a share of `wall_s`.
std::string stages_table(const std::vector<StageTiming>& stages, double wall_s);
/// Attempts, results and time of each loop matcher; empty if none was used.
std::string loop_matchers_table(const MappingResult& result);
/// The first loops of each verdict, folded away. loops.csv has all of them.
std::string loops_table(const MappingResult& result);
/// One table per section of the .ini file, folded away.
std::string settings_table(const std::map<std::string, std::string>& settings);

}  // namespace psi_slam
