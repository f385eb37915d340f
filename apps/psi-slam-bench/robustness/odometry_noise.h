// SPDX-License-Identifier: BSD-3-Clause
// Noise of odometry as a random walk: errors of successive stretches are independent, so that their variances
// grow with the distance and the rotation that odometry measures.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

namespace psi_slam {

struct OdometryNoise {
  double sigma_m_per_root_m = 0;      ///< of the position along each axis, after 1 m
  double sigma_rad_per_root_m = 0;    ///< of the heading, after 1 m straight ahead
  double sigma_rad_per_root_rad = 0;  ///< of the heading, after 1 rad on the spot
};

/// Measures the noise of odometry against the true poses of the robot: root mean squares of the differences
/// over successive stretches of at least 1 m or 1 rad by odometry. Compares positions along the true
/// headings, so that a wrong heading does not add to the error of the position. Splits the error of the
/// heading between distance and rotation by least squares; the split is ambiguous if both are always in the
/// same proportion. Zero without a complete stretch. Throws std::invalid_argument for paths of different
/// lengths.
OdometryNoise measure_odometry_noise(const std::vector<mrpt::math::TPose2D>& odom_T_robot,
                                     const std::vector<mrpt::math::TPose2D>& map_T_robot);

}  // namespace psi_slam
