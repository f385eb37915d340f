// SPDX-License-Identifier: BSD-3-Clause
// Operations on SE(2) poses that MRPT's TPose2D lacks.
#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>

namespace psi_slam {

/// Returns whether odometry can measure this pose: its numbers are finite, and it is at most 10,000 km from
/// the origin along each axis.
inline bool is_possible_odometry(const mrpt::math::TPose2D& odom_T_robot) {
  constexpr double kFarthest_m = 1e7;
  return std::abs(odom_T_robot.x) <= kFarthest_m && std::abs(odom_T_robot.y) <= kFarthest_m &&
         std::isfinite(odom_T_robot.phi);
}

/// Returns the inverse b_T_a of the pose a_T_b.
inline mrpt::math::TPose2D inverse(const mrpt::math::TPose2D& a_T_b) {
  return mrpt::math::TPose2D(0, 0, 0) - a_T_b;
}

/// Returns the pose at `fraction` of the way from one pose to another. Position and yaw change linearly; yaw
/// turns along the shorter arc.
inline mrpt::math::TPose2D interpolate(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to,
                                       double fraction) {
  const double turn_rad = mrpt::math::wrapToPi(to.phi - from.phi);
  return {from.x + fraction * (to.x - from.x), from.y + fraction * (to.y - from.y),
          mrpt::math::wrapToPi(from.phi + fraction * turn_rad)};
}

}  // namespace psi_slam
