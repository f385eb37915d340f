// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <string>

namespace psi_slam {

/// How a laser is mounted, projected to the floor.
struct FloorMount {
  mrpt::math::TPose2D robot_T_laser;
  bool upside_down = false;  ///< its readings run clockwise where it counts counter-clockwise
};

/// Throws UserError, beginning with `place`, when the laser is tilted by more than 15 degrees.
FloorMount floor_mount(const mrpt::poses::CPose3D& robot_T_laser, const std::string& place);

}  // namespace psi_slam
