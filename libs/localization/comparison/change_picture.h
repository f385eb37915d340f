// SPDX-License-Identifier: BSD-3-Clause
// The comparison of two maps as a picture, in the frame of map A.
#pragma once

#include <string>

#include "localization/comparison/wall_changes.h"

namespace psi_slam {

/// Draws the compared cells as the contents of a PNG file: walls of both maps dark, walls that appeared blue,
/// walls that vanished orange, an arrow from the old to the new place of a wall that moved, and walls where
/// the other map shows too little grey. A ring surrounds each change. A strip below the map has a scale bar
/// and the legend. Throws SystemFailure if the picture cannot be encoded.
std::string change_picture(const WallChanges& walls);

}  // namespace psi_slam
