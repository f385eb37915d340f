// SPDX-License-Identifier: BSD-3-Clause
// Predicts a robot's motion without odometry: it goes on at the speed it had. The speed is that of the last
// two scans that were matched, each where it was found.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>

#include "base/degrees.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

struct ConstantVelocityOptions {
  double acceleration_mps2 = 1.0;  ///< what it may gain or lose
  double turn_acceleration_radps2 = radians_from_degrees(90.0L);
  double first_speed_mps = 0.5;  ///< what it may move at as long as nothing is known
  double first_turn_radps = radians_from_degrees(30.0L);
  double longest_s =
      2.0;  ///< beyond so long without a match the speed is no longer believed: it may as well stand
};

struct PredictedMotion {
  mrpt::math::TPose2D motion;  ///< seen from the last pose: a steady arc, its end
  double sigma_m = 0;
  double sigma_rad = 0;
};

class ConstantVelocityModel {
 public:
  explicit ConstantVelocityModel(const ConstantVelocityOptions& options = {}) : options_(options) {}

  /// A scan's pose in any frame that stays the same, and whether it was found by a match; poses that were
  /// only predicted leave the speed as it was.
  void moved(TimeUs time_us, const mrpt::math::TPose2D& local_T_robot, bool matched);

  /// Where the robot is likely to be, seen from the last pose; it stands before there is any. Time that runs
  /// backwards is none.
  PredictedMotion predict(TimeUs time_us) const;

 private:
  struct Speed {  // along the robot's own axes, a second
    double x_mps = 0;
    double y_mps = 0;
    double turn_radps = 0;
  };
  struct Place {
    TimeUs time_us = 0;
    mrpt::math::TPose2D local_T_robot;
  };

  ConstantVelocityOptions options_;
  std::optional<Place> last_;
  std::optional<Place> last_matched_;
  std::optional<Speed> speed_;
};

}  // namespace psi_slam
