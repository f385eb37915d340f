// SPDX-License-Identifier: BSD-3-Clause
// Operations on SE(2) poses with the same results on every processor.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/math/wrap2pi.h>

#include <Eigen/Core>
#include <cmath>

#include "base/portable_math.h"

namespace psi_slam {

/// Returns whether odometry can measure this pose: its numbers are finite, and it is at most 10,000 km from
/// the origin along each axis.
inline bool is_possible_odometry(const mrpt::math::TPose2D& odom_T_robot) {
  constexpr double kFarthest_m = 1e7;
  return std::abs(odom_T_robot.x) <= kFarthest_m && std::abs(odom_T_robot.y) <= kFarthest_m &&
         std::isfinite(odom_T_robot.phi);
}

/// Returns the pose a_T_c = a_T_b ⊕ b_T_c: c in the frame a. Its yaw is in (-π, π]. Unlike MRPT's operator,
/// which calls the C library, it gives the same bits on every processor.
inline mrpt::math::TPose2D compose(const mrpt::math::TPose2D& a_T_b, const mrpt::math::TPose2D& b_T_c) {
  const auto [sin, cos] = portable::sin_cos(a_T_b.phi);
  return {a_T_b.x + b_T_c.x * cos - b_T_c.y * sin, a_T_b.y + b_T_c.x * sin + b_T_c.y * cos,
          mrpt::math::wrapToPi(a_T_b.phi + b_T_c.phi)};
}

/// Returns the pose b_T_c = ⊖a_T_b ⊕ a_T_c: c in the frame b, from both poses in the frame a. Its yaw is in
/// (-π, π].
inline mrpt::math::TPose2D between(const mrpt::math::TPose2D& a_T_b, const mrpt::math::TPose2D& a_T_c) {
  const auto [sin, cos] = portable::sin_cos(a_T_b.phi);
  const double x = a_T_c.x - a_T_b.x;
  const double y = a_T_c.y - a_T_b.y;
  return {x * cos + y * sin, y * cos - x * sin, mrpt::math::wrapToPi(a_T_c.phi - a_T_b.phi)};
}

/// Returns the inverse b_T_a of the pose a_T_b.
inline mrpt::math::TPose2D inverse(const mrpt::math::TPose2D& a_T_b) {
  return between(a_T_b, {0, 0, 0});
}

/// Returns the coordinates in the frame a of the point whose coordinates in the frame b are `point`.
inline mrpt::math::TPoint2D transform(const mrpt::math::TPose2D& a_T_b, const mrpt::math::TPoint2D& point) {
  const auto [sin, cos] = portable::sin_cos(a_T_b.phi);
  return {a_T_b.x + point.x * cos - point.y * sin, a_T_b.y + point.x * sin + point.y * cos};
}

/// Returns the 2×2 rotation matrix of an angle.
inline Eigen::Matrix2d rotation_matrix(double angle_rad) {
  const auto [sin, cos] = portable::sin_cos(angle_rad);
  Eigen::Matrix2d matrix;
  matrix << cos, -sin, sin, cos;
  return matrix;
}

/// Returns the distance between the positions of two points or poses, in metres.
template <class A, class B>
auto distance_m(const A& a, const B& b) {
  return portable::hypot(b.x - a.x, b.y - a.y);
}

/// Returns the pose at `fraction` of the way from one pose to another. Position and yaw change linearly; yaw
/// turns along the shorter arc.
inline mrpt::math::TPose2D interpolate(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to,
                                       double fraction) {
  if (fraction == 0) return from;
  if (fraction == 1) return to;  // exactly
  const double turn_rad = mrpt::math::wrapToPi(to.phi - from.phi);
  return {from.x + fraction * (to.x - from.x), from.y + fraction * (to.y - from.y),
          mrpt::math::wrapToPi(from.phi + fraction * turn_rad)};
}

}  // namespace psi_slam
