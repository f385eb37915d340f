// SPDX-License-Identifier: BSD-3-Clause
// Predicts the motion of a robot without odometry, from the velocity between the last two matched scans. If
// the scans have headings by a gyroscope, these predict the turn. If time stamps have stepped back lately,
// they are unreliable, and scans are taken to be evenly spaced in time.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>

#include "base/degrees.h"
#include "mapping/local_maps/gyroscope_model.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

struct ConstantVelocityOptions {
  double acceleration_mps2 = 1.0;  ///< standard deviation of the acceleration
  double turn_acceleration_radps2 = radians_from_degrees(90.0L);
  double unknown_speed_mps = 0.5;  ///< standard deviation of the speed while the speed is unknown
  double unknown_turn_radps = radians_from_degrees(30.0L);
  double longest_s = 2.0;  ///< after this time without a match, the speed counts as unknown
};

struct PredictedMotion {
  mrpt::math::TPose2D motion;  ///< motion along an arc, in the frame of the last pose
  double duration_s = 0;       ///< time since the last pose
  double sigma_m = 0;          ///< standard deviations of the motion since the last pose
  double sigma_rad = 0;
  double sigma_since_match_m = 0;  ///< standard deviations of the motion since the last matched pose
  double sigma_since_match_rad = 0;
  double sigma_without_gyroscope_rad = 0;  ///< sigma_since_match_rad if the gyroscope is wrong
};

class ConstantVelocityModel {
 public:
  explicit ConstantVelocityModel(const ConstantVelocityOptions& options = {}) : options_(options) {}

  /// Adds the pose of a scan, in any fixed frame. If `matched` is false, the pose is only a prediction and
  /// does not change the speed. The first pose always counts as matched. `imu_heading_rad` is the heading of
  /// the scan by a gyroscope, see Frame::imu_heading_rad. `in_mid_sweep` says that the pose is that in the
  /// middle of the sweep, not at its stamp. The model measures speeds only between two poses of the same
  /// kind.
  void moved(TimeUs time_us, const mrpt::math::TPose2D& local_T_robot, bool matched,
             std::optional<double> imu_heading_rad = std::nullopt, bool in_mid_sweep = false);

  /// Returns whether scans are missing before the scan at `time_us`: whether the time since the last pose is
  /// at least 2 s and ten times as long as usual. False if time stamps are unreliable.
  bool is_gap(TimeUs time_us) const;

  /// Time since the last matched pose, seconds.
  double unmatched_s(TimeUs time_us) const;

  /// Predicts the motion from the last pose to `time_us`. Returns zero motion before the first pose and while
  /// the speed is unknown. A time before the last pose counts as zero elapsed time. If the gyroscope knows
  /// the turn since the last pose and is credible, it replaces the turn at constant velocity.
  PredictedMotion predict(TimeUs time_us, std::optional<double> imu_heading_rad = std::nullopt) const;

 private:
  struct Speed {  // velocity along the axes of the robot
    double x_mps = 0;
    double y_mps = 0;
    double turn_radps = 0;
  };
  struct Place {
    double clock_s = 0;
    mrpt::math::TPose2D local_T_robot;
    bool matched = true;
    std::optional<double> imu_heading_rad;
    bool in_mid_sweep = false;
  };

  PredictedMotion predict_steady(TimeUs time_us) const;
  std::optional<double> turn_by_gyroscope_rad(std::optional<double> imu_heading_rad) const;
  void learn_gyroscope(double passed_s, const Place& here);
  double passed_s(TimeUs time_us) const;
  void update_clock(TimeUs time_us);

  ConstantVelocityOptions options_;
  std::optional<Place> last_;
  std::optional<Place> last_matched_;
  std::optional<Speed> speed_;
  GyroscopeModel gyroscope_;
  bool knows_turn_since_match_ = true;  ///< whether the gyroscope knows the turns since the last matched pose
  std::optional<TimeUs> last_time_us_;
  double clock_s_ = 0;         ///< sum of the times between scans
  double usual_step_s_ = 0;    ///< running estimate of the median time between scans; 0 if unknown
  double backward_steps_ = 0;  ///< decaying number of time stamps that were earlier than the previous one
};

}  // namespace psi_slam
