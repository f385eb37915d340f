// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/constant_velocity_model.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kShortest_s = 1e-3;          // smallest time between scans for computing a speed
constexpr double kMedianStep = 0.05;          // relative change of the running median with each scan
constexpr double kBackwardStepsKept = 0.995;  // factor of the number of backward steps with each scan
constexpr double kUnreliableBackwardSteps = 0.3;
constexpr double kLeastGap_s = 2;
constexpr double kGapSteps = 10;  // smallest gap, as a multiple of the usual time between scans

/// Rotates the translation of a motion by an angle. Rotation by minus half the turn of an arc makes its chord
/// point straight ahead.
TPose2D turned(const TPose2D& motion, double angle_rad) {
  const double c = portable::cos(angle_rad);
  const double s = portable::sin(angle_rad);
  return {c * motion.x - s * motion.y, s * motion.x + c * motion.y, motion.phi};
}

}  // namespace

double ConstantVelocityModel::passed_s(TimeUs time_us) const {
  if (!last_time_us_) return 0;
  const bool is_reliable = backward_steps_ < kUnreliableBackwardSteps || usual_step_s_ <= 0;
  return is_reliable ? std::max(0.0, seconds(time_us - *last_time_us_)) : usual_step_s_;
}

void ConstantVelocityModel::update_clock(TimeUs time_us) {
  clock_s_ += passed_s(time_us);
  if (last_time_us_) {
    const double step_s = seconds(time_us - *last_time_us_);
    backward_steps_ = kBackwardStepsKept * backward_steps_ + (step_s < 0 ? 1 : 0);
    if (usual_step_s_ > 0)
      usual_step_s_ *= step_s > usual_step_s_ ? 1 + kMedianStep : 1 - kMedianStep;
    else
      usual_step_s_ = std::max(0.0, step_s);
  }
  last_time_us_ = time_us;
}

/// Returns the turn since the last pose by the gyroscope, with its bias. Empty if the gyroscope does not know
/// it.
std::optional<double> ConstantVelocityModel::turn_by_gyroscope_rad(
    std::optional<double> imu_heading_rad) const {
  if (!last_ || !last_->imu_heading_rad || !imu_heading_rad) return std::nullopt;
  return *imu_heading_rad - *last_->imu_heading_rad;
}

void ConstantVelocityModel::learn_gyroscope(double passed_s, const Place& here) {
  const std::optional<double> turn_rad = turn_by_gyroscope_rad(here.imu_heading_rad);
  knows_turn_since_match_ = here.matched || (knows_turn_since_match_ && turn_rad);
  if (!turn_rad || !here.matched || !last_->matched || passed_s < kShortest_s) return;
  gyroscope_.learn(passed_s, *turn_rad, here.local_T_robot.phi - last_->local_T_robot.phi,
                   speed_ ? speed_->turn_radps * passed_s : 0);
}

void ConstantVelocityModel::moved(TimeUs time_us, const TPose2D& local_T_robot, bool matched,
                                  std::optional<double> imu_heading_rad, bool in_mid_sweep) {
  const double passed_s = this->passed_s(time_us);
  update_clock(time_us);
  const Place here{clock_s_, local_T_robot, matched || !last_, imu_heading_rad, in_mid_sweep};
  learn_gyroscope(passed_s, here);
  if (here.matched) {
    if (last_matched_ && last_matched_->in_mid_sweep == in_mid_sweep) {
      const double matched_s = clock_s_ - last_matched_->clock_s;
      TPose2D motion = between(last_matched_->local_T_robot, local_T_robot);
      motion.phi = mrpt::math::wrapToPi(motion.phi);
      const TPose2D straight = turned(motion, -motion.phi / 2);
      if (matched_s >= kShortest_s)
        speed_ = Speed{straight.x / matched_s, straight.y / matched_s, straight.phi / matched_s};
    }
    last_matched_ = here;
  }
  last_ = here;
}

bool ConstantVelocityModel::is_gap(TimeUs time_us) const {
  const double passed_s = this->passed_s(time_us);
  return usual_step_s_ > 0 && passed_s >= std::max(kLeastGap_s, kGapSteps * usual_step_s_);
}

double ConstantVelocityModel::unmatched_s(TimeUs time_us) const {
  return last_matched_ ? clock_s_ + passed_s(time_us) - last_matched_->clock_s : 0;
}

PredictedMotion ConstantVelocityModel::predict(TimeUs time_us, std::optional<double> imu_heading_rad) const {
  PredictedMotion predicted = predict_steady(time_us);
  predicted.sigma_without_gyroscope_rad = predicted.sigma_since_match_rad;
  const std::optional<double> measured_rad = turn_by_gyroscope_rad(imu_heading_rad);
  if (!measured_rad || !gyroscope_.is_credible()) return predicted;
  const double passed_s = this->passed_s(time_us);
  TPose2D straight = turned(predicted.motion, -predicted.motion.phi / 2);
  straight.phi = mrpt::math::wrapToPi(gyroscope_.turn_rad(*measured_rad, passed_s));
  predicted.motion = turned(straight, straight.phi / 2);
  predicted.sigma_rad = GyroscopeModel::kSigma_radps * passed_s;
  if (knows_turn_since_match_)
    predicted.sigma_since_match_rad = GyroscopeModel::kSigma_radps * unmatched_s(time_us);
  return predicted;
}

PredictedMotion ConstantVelocityModel::predict_steady(TimeUs time_us) const {
  PredictedMotion predicted;
  if (!last_) return predicted;
  const double passed_s = this->passed_s(time_us);
  const double unmatched_s = this->unmatched_s(time_us);
  predicted.duration_s = passed_s;
  if (!speed_ || unmatched_s > options_.longest_s) {
    predicted.sigma_m = options_.unknown_speed_mps * passed_s;
    predicted.sigma_rad = options_.unknown_turn_radps * passed_s;
    predicted.sigma_since_match_m = options_.unknown_speed_mps * unmatched_s;
    predicted.sigma_since_match_rad = options_.unknown_turn_radps * unmatched_s;
    return predicted;
  }
  const TPose2D straight{speed_->x_mps * passed_s, speed_->y_mps * passed_s,
                         mrpt::math::wrapToPi(speed_->turn_radps * passed_s)};
  predicted.motion = turned(straight, straight.phi / 2);
  predicted.sigma_m = options_.acceleration_mps2 * passed_s * passed_s;
  predicted.sigma_rad = options_.turn_acceleration_radps2 * passed_s * passed_s;
  predicted.sigma_since_match_m = options_.acceleration_mps2 * unmatched_s * unmatched_s;
  predicted.sigma_since_match_rad = options_.turn_acceleration_radps2 * unmatched_s * unmatched_s;
  return predicted;
}

}  // namespace psi_slam
