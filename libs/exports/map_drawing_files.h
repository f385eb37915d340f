// SPDX-License-Identifier: BSD-3-Clause
// A map drawing as the text of a file: SVG for people, DXF for CAD programs.
#pragma once

#include <string>

#include "rendering/map_drawing.h"

namespace psi_slam {

/// Returns the drawing as DXF release 12, which every CAD program reads, in metres in the map's frame: closed
/// polylines on layer WALLS, open ones on layer TRAJECTORY. Outlines of two points become lines.
std::string map_dxf(const MapDrawing& drawing);

/// Returns the drawing as SVG that prints at 1:`scale`, with scale bar and axes below the map. The unit is
/// one metre, and groups "walls" and "trajectory" use map coordinates; width and height are millimetres of
/// paper.
std::string map_svg(const MapDrawing& drawing, double scale);

}  // namespace psi_slam
