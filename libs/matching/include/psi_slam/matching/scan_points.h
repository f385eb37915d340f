// SPDX-License-Identifier: BSD-3-Clause
// The points of one scan as the matchers take them.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

namespace psi_slam {

/// Points of one scan in the robot's frame, metres.
struct ScanPoints {
  std::vector<mrpt::math::TPoint2Df> points;
  /// For each point the unit normal of the straight surface it lies on, (0, 0) where there is none; empty:
  /// unknown.
  std::vector<mrpt::math::TPoint2Df> normals;
  mrpt::math::TPoint2Df origin{0, 0};  ///< of the beams: the laser's position on the robot
  double farthest_m = 0;  ///< d_max of equation 7: the largest distance of a point from the robot
};

}  // namespace psi_slam
