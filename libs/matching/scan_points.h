// SPDX-License-Identifier: BSD-3-Clause
// The points of one scan as the matchers take them.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <vector>

namespace psi_slam {

/// Of a frame that holds scans of several lasers: a run of points that one of them saw.
struct LaserPoints {
  std::size_t first_point = 0;
  mrpt::math::TPoint2Df origin{0, 0};  ///< of its beams, in the robot's frame
};

/// Points of one scan in the robot's frame, metres.
struct ScanPoints {
  std::vector<mrpt::math::TPoint2Df> points;
  /// For each point the unit normal of the straight surface it lies on, (0, 0) where there is none; empty:
  /// unknown.
  std::vector<mrpt::math::TPoint2Df> normals;
  mrpt::math::TPoint2Df origin{0, 0};  ///< of the beams: the laser's position on the robot
  double farthest_m = 0;  ///< d_max of equation 7: the largest distance of a point from the robot
  /// Where the points of the robot's other lasers begin, ascending; those before are seen from `origin`.
  std::vector<LaserPoints> other_lasers;
};

/// Calls `take(origin, first, end)` for each run of points that one laser saw.
template <class Take>
void for_each_laser(const ScanPoints& scan, Take take) {
  std::size_t first = 0;
  mrpt::math::TPoint2Df origin = scan.origin;
  for (const LaserPoints& other : scan.other_lasers) {
    take(origin, first, other.first_point);
    first = other.first_point;
    origin = other.origin;
  }
  take(origin, first, scan.points.size());
}

}  // namespace psi_slam
