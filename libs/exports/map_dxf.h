// SPDX-License-Identifier: BSD-3-Clause
// The map as a DXF drawing for CAD programs: release 12, the one that every program reads.
#pragma once

#include <string>

#include "rendering/map_drawing.h"

namespace psi_slam {

/// The file's text, in metres, in the map's frame: closed polylines on the layer WALLS, a line where a wall
/// is only one, and an open polyline on the layer TRAJECTORY.
std::string map_dxf(const MapDrawing& drawing);

}  // namespace psi_slam
