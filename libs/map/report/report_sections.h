// SPDX-License-Identifier: BSD-3-Clause
// The sections of report.html, each returned as HTML or inline SVG.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <map>
#include <string>
#include <vector>

#include "map/exports/run_summary.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

extern const char* const kReportLogo;   ///< logo as SVG
extern const char* const kReportStyle;  ///< CSS of the page
/// JavaScript that zooms and moves the map; the page works without it.
extern const char* const kReportScript;

/// The map as an image, with layers that checkboxes show or hide without a script: trajectory coloured by
/// time, unmatched scans, odometry, path of the front end, loops of each state, and the hot spots of
/// `summary.verdict` with their suspects.
std::string report_map(const MappingResult& result, const RunSummary& summary,
                       const mrpt::maps::COccupancyGridMap2D& grid);
/// The verdict about the map as a sentence, and a table of its hot spots.
std::string verdict_section(const MapVerdict& verdict);

/// Plot of the front end's response over time: mean and range of each stretch of time, unmatched scans, and
/// the times at which loops were closed.
std::string response_plot(const MappingResult& result, const UnmatchedScans& unmatched);
/// Table of the stretches of unmatched scans, collapsed; empty if there are none.
std::string unmatched_table(const UnmatchedScans& unmatched);
/// Plot of the factor Psi over time with its thresholds on a logarithmic axis, and below it the searches
/// that ran.
std::string psi_plot(const MappingResult& result);
/// Legend with the colours of the searches that ran.
std::string psi_key(const MappingResult& result);
/// Plot of the time to match the loops of each node, on a logarithmic axis, over the time of the log.
std::string loop_matching_plot(const MappingResult& result);
/// Plot of the processing time of each scan, on a logarithmic axis, over the time of the log. A line marks
/// the mean time between two scans.
std::string work_plot(const MappingResult& result);

/// Tiles with the main figures of the run.
std::string key_figures(const RunSummary& summary);
/// Table of facts about the input log.
std::string log_table(const MappedLogFacts& log, const std::string& name);
/// Bars that show why loops were rejected, and how often.
std::string reasons_table(const LoopCounts& loops);
/// Table of the time spent in each stage, also as a share of `wall_s`, the time of the whole run in seconds.
std::string stages_table(const std::vector<StageTiming>& stages, double wall_s);
/// Table of the attempts, results and time of each loop matcher and of each search that it ran. Empty if no
/// matcher was used.
std::string loop_matchers_table(const MappingResult& result);
/// Table of the first 100 loops edited by hand, and of the other accepted loops, outlier loops, candidates
/// and rejected loops, collapsed. loops.csv has all loops.
std::string loops_table(const MappingResult& result);
/// One table for each section of the settings, collapsed. `settings` maps "section.key" to the value.
std::string settings_table(const std::map<std::string, std::string>& settings);

}  // namespace psi_slam
