// SPDX-License-Identifier: BSD-3-Clause
// Normals of the straight surfaces that a scan saw, from lines through neighbouring points.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

namespace psi_slam {

/// Returns for each point the unit normal of the line through it and its neighbours, at most three on each
/// side. The points are those of one laser in the order of the beams, in the robot's frame, metres. A normal
/// is (0, 0) if the point and its neighbours are fewer than 4, or do not lie on a line. `is_ring`: the last
/// point and the first are neighbours.
std::vector<mrpt::math::TPoint2Df> surface_normals(const std::vector<mrpt::math::TPoint2Df>& points,
                                                   bool is_ring);

/// Returns for each point the unit normal of the line through its neighbours, without the point itself. So
/// the errors of the normal and of the point are independent. A normal is (0, 0) if the point and its
/// neighbours are fewer than 4, or if the neighbours do not lie on a line. The points are not a ring.
std::vector<mrpt::math::TPoint2Df> normals_of_neighbours(const std::vector<mrpt::math::TPoint2Df>& points);

}  // namespace psi_slam
