// SPDX-License-Identifier: BSD-3-Clause
// Stretches of the path whose scans leave a direction open: in a bare corridor or beside one straight wall,
// all surfaces face the same way. Then the match does not determine the position along the wall, however
// well the scan fits. Odometry, or the constant-velocity model without odometry, gives the length of the map
// there. The covariance of the match does not show it, because noise of the ranges looks like structure.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "matching/surface_alignment.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

struct MapView;

/// Returns the unit vector u along which the surfaces leave the position open: with the normals n_j, the sum
/// of (n_j . u)^2 is smallest along u, and smaller than kPriorPoints. Expects the points of one view, see
/// MapViewOptions::max_points. Empty without such a direction, and without points.
std::optional<mrpt::math::TPoint2D> open_direction(const SurfacePoints& surfaces);

/// Views of one run with an open direction, at most kLargestStep views apart.
struct OpenStretch {
  std::size_t first_frame = 0;  ///< first frame whose position is open
  std::size_t last_frame = 0;   ///< last frame whose position is open
  double length_m = 0;          ///< motion along the open directions
  mrpt::math::TPoint2D at;      ///< place in the map: the middle of the stretch
  bool has_odometry = false;    ///< whether odometry measured all of this motion
};

/// Returns the stretches along which the robot moved by least_length_m or more in open directions, in the
/// order of the log.
std::vector<OpenStretch> open_stretches(const MappingResult& result, const std::vector<MapView>& views,
                                        double least_length_m);

}  // namespace psi_slam
