// SPDX-License-Identifier: BSD-3-Clause
// The map as an SVG drawing, walls as vectors, true to scale when it is printed.
#pragma once

#include <string>

#include "rendering/map_drawing.h"

namespace psi_slam {

/// The file's text. One unit of the drawing is a metre, x and y within its groups "walls" and "trajectory"
/// are those of the map; width and height are in millimetres of paper at 1:`scale`. Scale bar and axes stand
/// below the map.
std::string map_svg(const MapDrawing& drawing, double scale);

}  // namespace psi_slam
