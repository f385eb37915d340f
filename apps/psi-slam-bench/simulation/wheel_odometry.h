// SPDX-License-Identifier: BSD-3-Clause
// What wheel odometry makes of a motion. Its random errors are walks: their variances grow in proportion to
// the way driven and the angle turned, however fine the steps. On top of them come errors of scale that last.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>

#include "base/degrees.h"
#include "simulation/simulation_random.h"

namespace psi_slam {

struct WheelOdometryOptions {
  std::uint64_t seed = 1;
  double length_scale = 1.01;        ///< of every length: a wheel smaller than stated
  double turn_scale = 1.01;          ///< of every turn: wheels farther apart than stated
  double sigma_m_per_root_m = 0.01;  ///< of the length, after one metre; twice that after four
  double sigma_rad_per_root_m = radians_from_degrees(0.4L);  ///< of the heading, after one metre
  double sigma_rad_per_root_rad =
      radians_from_degrees(1.0L);  ///< of the heading, after turning by one radian
};

class WheelOdometry {
 public:
  explicit WheelOdometry(const WheelOdometryOptions& options)
      : options_(options), random_(options.seed, SimulationRandom::Stream::kOdometry) {}

  /// The robot's odometry after it moved by `before_T_now` since the last call; it starts at the origin.
  mrpt::math::TPose2D move(const mrpt::math::TPose2D& before_T_now);

 private:
  WheelOdometryOptions options_;
  SimulationRandom random_;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};
};

}  // namespace psi_slam
