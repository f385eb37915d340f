// SPDX-License-Identifier: BSD-3-Clause
// Points of one scan, the input of the matchers.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <vector>

namespace psi_slam {

/// First point and position of one further laser, in a frame with scans of several lasers.
struct LaserPoints {
  std::size_t first_point = 0;         ///< index into ScanPoints::points
  mrpt::math::TPoint2Df origin{0, 0};  ///< position of the laser in the robot's frame
};

/// Points of one frame, from one or several lasers, in the robot's frame, metres.
struct ScanPoints {
  std::vector<mrpt::math::TPoint2Df> points;
  /// Unit normal of the straight surface at each point; (0, 0) for a point without such a surface. Empty:
  /// unknown.
  std::vector<mrpt::math::TPoint2Df> normals;
  mrpt::math::TPoint2Df origin{0, 0};  ///< position of the first laser in the robot's frame
  double farthest_m = 0;               ///< d_max of equation 7: largest distance of a point from the robot
  /// Further lasers, by ascending first_point. All earlier points were seen from `origin`.
  std::vector<LaserPoints> other_lasers;
};

/// Calls `take(origin, first, end)` for each laser, with its position and the range [first, end) of its
/// points.
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
