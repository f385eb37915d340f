// SPDX-License-Identifier: BSD-3-Clause
// report.html: one page that shows a run to a person. The file needs no network: style, script and images are
// inside.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <string>

#include "map/exports/run_summary.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Returns the page: key figures, map with trajectory and loops, plots over time, which loops were closed or
/// rejected and why, the input log, the files and the settings. `grid` is the map of `result`.
std::string report_html(const MappingResult& result, const RunInfo& info, const RunSummary& summary,
                        const mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace psi_slam
