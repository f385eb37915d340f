// SPDX-License-Identifier: BSD-3-Clause
// The beams of scans as rays in the map, for drawing.
#pragma once

#include <mrpt/math/TBoundingBox.h>
#include <mrpt/math/TPose2D.h>

#include <deque>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/grid_map.h"

namespace psi_slam {

/// End point of a beam in the map's frame, in metres, and the evidence that the beam gives.
struct Ray {
  mrpt::math::TPoint2D end;
  bool hit = false;       // an obstacle is at the end point
  bool returned = false;  // if false, the beam may have crossed glass or met a black surface
  /// Share of the ray's length from which on no neighbouring beam of the scan supports it: both end nearer.
  /// 1: a neighbour ended as far away.
  double alone_from = 1;
};

/// The rays of one scan. They all start at its laser.
struct Fan {
  mrpt::math::TPoint2D start;
  std::vector<Ray> rays;
  BeamBearings bearings;          // beam bearings of the laser's last scan
  std::vector<double> lengths_m;  // of the beams as drawn; 0 for an invalid reading
};

/// Turns scans into rays in the map's frame.
class RayMaker {
 public:
  explicit RayMaker(const GridMapOptions& options) : options_(options) {}

  /// Returns the rays of all scans of a frame, none of them for Frame::is_misplaced. The pointers are valid
  /// until the next call. Throws std::invalid_argument if the numbers of ranges and bearings differ or a pose
  /// is not finite.
  const std::vector<const Fan*>& fans(const Frame& frame, const mrpt::math::TPose2D& map_T_robot);

 private:
  void cast(const LaserScan& scan, const mrpt::math::TPose2D& map_T_robot, Fan& fan) const;

  GridMapOptions options_;
  std::deque<Fan> lasers_;  // index: laser; a deque keeps pointers to its elements valid
  std::vector<const Fan*> fans_;
};

/// Returns the smallest box, in metres, that holds all rays; z is 0. Without rays, an inverted infinite box.
mrpt::math::TBoundingBox bounds_of(const std::vector<const Fan*>& fans);

}  // namespace psi_slam
