// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/wheel_odometry.h"

#include <cmath>

namespace psi_slam {

mrpt::math::TPose2D WheelOdometry::move(const mrpt::math::TPose2D& before_T_now) {
  const double way_m = std::hypot(before_T_now.x, before_T_now.y);
  const double turned_rad = std::abs(before_T_now.phi);
  const double root_m = std::sqrt(way_m);
  const double length_error_m = options_.sigma_m_per_root_m * root_m * random_.normal();
  const double drift_rad = options_.sigma_rad_per_root_m * root_m * random_.normal();
  const double turn_error_rad = options_.sigma_rad_per_root_rad * std::sqrt(turned_rad) * random_.normal();
  const double longer_m = (options_.length_scale - 1) * way_m + length_error_m;
  const double stretch = way_m > 0 ? 1 + longer_m / way_m : 1;
  const double turn = options_.turn_scale * before_T_now.phi + drift_rad + turn_error_rad;
  odom_T_robot_ =
      odom_T_robot_ + mrpt::math::TPose2D(stretch * before_T_now.x, stretch * before_T_now.y, turn);
  odom_T_robot_.normalizePhi();
  return odom_T_robot_;
}

}  // namespace psi_slam
