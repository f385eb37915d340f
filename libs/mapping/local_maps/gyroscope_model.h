// SPDX-License-Identifier: BSD-3-Clause
// Turns of the robot by a gyroscope, corrected by matched scans. The model learns the bias of the gyroscope.
// It also compares the errors of the gyroscope with the errors of a constant rate of turn: a gyroscope with a
// wrong axis, sign or unit is not credible.
#pragma once

#include "base/degrees.h"

namespace psi_slam {

class GyroscopeModel {
 public:
  /// Standard deviation of the rate of turn after the correction, radians per second.
  static constexpr double kSigma_radps = radians_from_degrees(5.0L);

  /// Returns the turn during `passed_s` seconds without the bias of the gyroscope, radians.
  double turn_rad(double measured_rad, double passed_s) const {
    return measured_rad - bias_radps_ * passed_s;
  }

  /// Returns whether the gyroscope predicts turns at least as well as a constant rate of turn does, or with a
  /// small error.
  bool is_credible() const;

  /// Learns from two successive matched scans, `passed_s` > 0 seconds apart: the turn by the gyroscope, the
  /// turn between the matched poses, and the turn that a constant rate of turn predicted, radians.
  void learn(double passed_s, double measured_rad, double matched_rad, double steady_rad);

 private:
  double bias_radps_ = 0;
  int learned_scans_ = 0;
  double squared_error_ = 0;  ///< decaying mean over the scans, square radians
  double squared_error_of_steady_turns_ = 0;
};

}  // namespace psi_slam
