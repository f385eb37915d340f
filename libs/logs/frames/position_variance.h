// SPDX-License-Identifier: BSD-3-Clause
// How uncertain the position of a pose is.
#pragma once

#include <Eigen/Core>

#include "base/portable_math.h"

namespace psi_slam {

/// Returns the variance of the position along its most uncertain direction, in m^2: the largest eigenvalue of
/// the block of x and y. `covariance` is that of a pose (x, y, heading), in metres and radians.
inline double largest_position_variance_m2(const Eigen::Matrix3d& covariance) {
  const double mean = 0.5 * (covariance(0, 0) + covariance(1, 1));
  return mean + portable::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
}

}  // namespace psi_slam
