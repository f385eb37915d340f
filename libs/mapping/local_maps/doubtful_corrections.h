// SPDX-License-Identifier: BSD-3-Clause
// Limits doubtful corrections of odometry: corrections that only a small part of the scan supports. People
// who walk with the robot cause such corrections. A doubtful correction is applied only if errors of odometry
// can explain it, by itself and together with the doubtful corrections before it.
//
// Limit of a single correction: it is at most `max_sigmas` standard deviations of the motion by odometry. The
// motion is that since the last applied correction, so the map can correct an error of odometry that
// persists. Robots differ, so the standard deviation is multiplied by a scale. The scale is the root mean
// square ratio of supported corrections to their standard deviation, at least 1.
//
// Limit of the sum of corrections, which decays with travel: it is at most `max_sum_m` times the scale, or
// the limit of a single correction over one step if that is larger. So the limit grows with the distance
// between scans.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace psi_slam {

struct DoubtfulCorrectionOptions {
  double max_sigmas = 3;
  double max_sum_m = 0.2;
  double travel_m = 4.5;  ///< travel over which the sum of corrections falls to 1/e
};

class DoubtfulCorrections {
 public:
  explicit DoubtfulCorrections(const DoubtfulCorrectionOptions& options) : options_(options) {}

  /// Begins a step: odometry measured a motion of length `length_m`, with the standard deviation `sigma_m`.
  /// An empty `sigma_m` means that there is no odometry. Then only the sum is limited, to `max_sum_m`.
  void moved(double length_m, std::optional<double> sigma_m);

  /// Ends a step whose correction has the length `correction_m` and is supported by enough of the scan.
  void add_supported(double correction_m);

  /// Ends a step whose pose is that of the match, whatever its correction.
  void add_unjudged() { variance_m2_ = 0; }

  /// Ends a step with a doubtful correction, along the robot's axes. Returns false if the correction must not
  /// be applied.
  bool add_doubtful(const Eigen::Vector2d& correction_m);

  /// Standard deviation of the motion by odometry since the last correction that was applied, times the
  /// scale.
  double sigma_m() const;

 private:
  double scale() const;
  double max_sum_m() const;

  DoubtfulCorrectionOptions options_;
  double step_sigma_m_ = 0;  ///< standard deviation of the last motion
  double variance_m2_ = 0;   ///< of the motion since the last step whose correction was applied
  double mean_square_ = 1;   ///< decaying mean of the squared ratios of supported corrections to their sigma
  Eigen::Vector2d sum_m_ = Eigen::Vector2d::Zero();  ///< decaying sum of applied corrections, robot's axes
};

}  // namespace psi_slam
