// SPDX-License-Identifier: BSD-3-Clause
// The direction of most walls in a building with right angles.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Returns the direction of most walls in the map, modulo 90 degrees, in (-45, 45] degrees: turning the map
/// by minus this angle lays them along the axes. Uses straight pieces of the scans of all lasers, each frame
/// at the robot pose with the same index. Returns 0 if the scans have no straight piece.
double wall_direction_rad(const std::vector<Frame>& log, const std::vector<mrpt::math::TPose2D>& map_T_robot);

}  // namespace psi_slam
