// SPDX-License-Identifier: BSD-3-Clause
// The report's map: the gridmap as an image inside an SVG, and over it the trajectory coloured by time, raw
// odometry, the front end's path and the loops, each in a layer of its own that a checkbox shows or hides
// without any script.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <string>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// The figure as HTML: checkboxes, the SVG and its legend.
std::string report_map(const MappingResult& result, const mrpt::maps::COccupancyGridMap2D& grid);

}  // namespace psi_slam
