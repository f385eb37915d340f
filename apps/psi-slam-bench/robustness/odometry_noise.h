// SPDX-License-Identifier: BSD-3-Clause
// How noisy odometry is, as a random walk: errors of successive stretches are independent, so that their
// variances grow with the way and the turn that odometry tells.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

namespace psi_slam {

struct OdometryNoise {
  double sigma_m_per_root_m = 0;      ///< of the position, along each axis, after a metre
  double sigma_rad_per_root_m = 0;    ///< of the heading, after a metre straight ahead
  double sigma_rad_per_root_rad = 0;  ///< of the heading, after a radian on the spot
};

/// Of odometry against where the robot was, pose by pose: the root mean squares of their differences over
/// successive stretches of at least 1 m or 1 rad by odometry. Positions are compared along the true headings,
/// so that a turn wrongly measured is no error of the way after it. The heading's is split between way and
/// turn by least squares; a drive whose ways and turns come in one proportion tells their sum only. Throws
/// std::invalid_argument when the two are not of one length. No stretch, no noise.
OdometryNoise measure_odometry_noise(const std::vector<mrpt::math::TPose2D>& odom_T_robot,
                                     const std::vector<mrpt::math::TPose2D>& map_T_robot);

}  // namespace psi_slam
