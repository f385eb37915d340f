// SPDX-License-Identifier: BSD-3-Clause
// Refines a pose below a cell, by Levenberg-Marquardt on the interpolated score grid (equation 2).
//
//     minimise over the pose:  sum_j (1 - M(T p_j))^2 / s^2  +  (x - x_prior)^T P^-1 (x - x_prior)
//
// with s the standard deviation of one point's score. The information matrix of the match is J^T J / s^2, the
// Gauss-Newton approximation of the second derivative. Along a corridor it is nearly singular.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <optional>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

struct RefinementOptions {
  int max_iterations = 12;
  double score_sigma = 0.5;  ///< s: deviation of a point's score from 1, with correlation between neighbours
  double converged_step_m = 2e-5;  ///< stops at smaller steps whose turn is below a tenth of this, in radians
  double max_shift_m = 0.15;       ///< returns the start if the pose moved farther: that is another peak
};

/// Knowledge of the pose besides the scan, such as odometry.
struct PosePrior {
  mrpt::math::TPose2D map_T_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< order x, y, theta
};

struct RefinedPose {
  mrpt::math::TPose2D map_T_robot;
  double mean_score = 0;                                  ///< mean score of the points, in [0, 1]
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan alone, without the prior
  int iterations = 0;
};

/// Refines a pose from `map_T_robot`. If nothing is known, the prior is the start with a standard deviation
/// of 0.15 m in position; otherwise noise would move the pose along a corridor.
RefinedPose refine(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot,
                   const RefinementOptions& options, const std::optional<PosePrior>& known = {});

/// Inverts an information matrix and bounds the standard deviations to [min, max] along its principal axes,
/// so that a singular matrix stays usable. For the bounds, radians are scaled by `lever_m` metres.
Eigen::Matrix3d bounded_covariance(const Eigen::Matrix3d& information, double min_sigma_m, double max_sigma_m,
                                   double lever_m);

}  // namespace psi_slam
