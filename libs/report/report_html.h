// SPDX-License-Identifier: BSD-3-Clause
// report.html: one page that shows a run to a person: key figures, the map with trajectory and loops, what
// was read, how the time was spent, which loops were closed or refused and why, and with what settings. It is
// one file that needs no network: style, script and pictures are inside.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <string>

#include "psi_slam/mapping_result.h"
#include "exports/run_summary.h"

namespace psi_slam {

std::string report_html(const MappingResult& result, const RunInfo& info, const RunSummary& summary,
                        const mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace psi_slam
