// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>

namespace psi_slam {

/// Where a drive begins that no odometry joins to what was mapped before: seen from a node of the graph. It
/// was found out farther on along the drive, and there it is known best.
struct RunStart {
  std::size_t node = 0;
  mrpt::math::TPose2D node_T_robot;
  mrpt::math::TPose2D robot_T_found;  ///< the robot where its place was found, seen from where it began
};

}  // namespace psi_slam
