// SPDX-License-Identifier: BSD-3-Clause
// Floor plans in DXF files.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace psi_slam {

struct PlanDrawingOptions {
  std::optional<double> metres_per_unit;  ///< empty: the unit that the drawing states, $INSUNITS
  std::string layers;  ///< layers with walls, separated by commas; empty: all but TRAJECTORY
};

struct PlanDrawing {
  mrpt::maps::COccupancyGridMap2D grid;
  std::vector<std::string> layers;  ///< names of all layers on which something is drawn, sorted
};

/// Returns whether a file name ends in .dxf, in upper or lower case.
bool is_plan_drawing(const std::filesystem::path& path);

/// Draws the lines of a DXF file as walls into free space. The map has the drawing's origin and axes. Its
/// cells have 0.05 m, or 0.1 or 0.2 m if the drawing has more than 100 million smaller cells. If no
/// layers are chosen, leaves out the layer TRAJECTORY, which is the path in drawings of psi-slam. Throws
/// UserError if the file is unreadable, if its unit is unknown, or if the chosen layers have no lines or an
/// implausible extent.
PlanDrawing read_plan_drawing(const std::filesystem::path& path, const PlanDrawingOptions& options);

}  // namespace psi_slam
