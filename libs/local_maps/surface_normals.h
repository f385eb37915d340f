// SPDX-License-Identifier: BSD-3-Clause
// Normals of the straight surfaces that a scan saw, from lines through neighbouring points.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <vector>

namespace psi_slam {

/// Returns the unit normal of the line through a point and its neighbours, at most three on each side. The
/// points are those of one laser in the order of the beams, in the robot's frame, metres. Returns (0, 0) if
/// these are fewer than 4 points, or do not lie on a line. `is_ring`: the last point and the first are
/// neighbours.
mrpt::math::TPoint2Df surface_normal(const std::vector<mrpt::math::TPoint2Df>& points, std::size_t index,
                                     bool is_ring);

/// Returns the unit normal of the line through the neighbours of a point, without the point itself. So the
/// errors of the normal and of the point are independent. Returns (0, 0) like surface_normal().
mrpt::math::TPoint2Df normal_of_neighbours(const std::vector<mrpt::math::TPoint2Df>& points,
                                           std::size_t index);

}  // namespace psi_slam
