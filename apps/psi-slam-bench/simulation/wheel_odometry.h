// SPDX-License-Identifier: BSD-3-Clause
// Simulated wheel odometry. Random errors are random walks: their variances grow in proportion to distance
// and rotation, independent of the step size. Scale errors are constant.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>

#include "base/degrees.h"
#include "simulation/simulation_random.h"

namespace psi_slam {

struct WheelOdometryOptions {
  std::uint64_t seed = 1;
  double length_scale = 1.01;        ///< factor of distances; above 1 for wheels smaller than assumed
  double turn_scale = 1.01;          ///< factor of rotations; above 1 for wheels farther apart than assumed
  double sigma_m_per_root_m = 0.01;  ///< of the distance, after 1 m; twice that after 4 m
  double sigma_rad_per_root_m = radians_from_degrees(0.4L);    ///< of the heading, after 1 m
  double sigma_rad_per_root_rad = radians_from_degrees(1.0L);  ///< of the heading, after 1 rad
};

class WheelOdometry {
 public:
  explicit WheelOdometry(const WheelOdometryOptions& options)
      : options_(options), random_(options.seed, SimulationRandom::Stream::kOdometry) {}

  /// Odometry of the robot after a motion by `before_T_now` since the last call. Starts at the origin.
  mrpt::math::TPose2D move(const mrpt::math::TPose2D& before_T_now);

 private:
  WheelOdometryOptions options_;
  SimulationRandom random_;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};
};

}  // namespace psi_slam
