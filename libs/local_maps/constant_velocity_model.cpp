// SPDX-License-Identifier: BSD-3-Clause
#include "local_maps/constant_velocity_model.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kShortest_s = 1e-3;  // smallest time between scans for computing a speed

/// Rotates the translation of a motion by an angle. Rotation by minus half the turn of an arc makes its chord
/// point straight ahead.
TPose2D turned(const TPose2D& motion, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * motion.x - s * motion.y, s * motion.x + c * motion.y, motion.phi};
}

}  // namespace

void ConstantVelocityModel::moved(TimeUs time_us, const TPose2D& local_T_robot, bool matched) {
  const Place here{time_us, local_T_robot};
  if (matched || !last_) {
    if (last_matched_) {
      const double passed_s = seconds(time_us - last_matched_->time_us);
      TPose2D motion = local_T_robot - last_matched_->local_T_robot;
      motion.phi = mrpt::math::wrapToPi(motion.phi);
      const TPose2D straight = turned(motion, -motion.phi / 2);
      if (passed_s >= kShortest_s)
        speed_ = Speed{straight.x / passed_s, straight.y / passed_s, straight.phi / passed_s};
    }
    last_matched_ = here;
  }
  last_ = here;
}

PredictedMotion ConstantVelocityModel::predict(TimeUs time_us) const {
  PredictedMotion predicted;
  if (!last_) return predicted;
  const double passed_s = std::max(0.0, seconds(time_us - last_->time_us));
  const double unmatched_s = std::max(0.0, seconds(time_us - last_matched_->time_us));
  if (!speed_ || unmatched_s > options_.longest_s) {
    predicted.sigma_m = options_.first_speed_mps * passed_s;
    predicted.sigma_rad = options_.first_turn_radps * passed_s;
    return predicted;
  }
  const TPose2D straight{speed_->x_mps * passed_s, speed_->y_mps * passed_s,
                         mrpt::math::wrapToPi(speed_->turn_radps * passed_s)};
  predicted.motion = turned(straight, straight.phi / 2);
  predicted.sigma_m = options_.acceleration_mps2 * passed_s * passed_s;
  predicted.sigma_rad = options_.turn_acceleration_radps2 * passed_s * passed_s;
  return predicted;
}

}  // namespace psi_slam
