// SPDX-License-Identifier: BSD-3-Clause
// Names of the layers of map.dxf.
#pragma once

namespace psi_slam {

inline constexpr const char* kWallLayer = "WALLS";
inline constexpr const char* kTrajectoryLayer = "TRAJECTORY";  ///< the robot's path

}  // namespace psi_slam
