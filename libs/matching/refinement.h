// SPDX-License-Identifier: BSD-3-Clause
// Refines a pose below the size of a cell, by Levenberg-Marquardt on the interpolated score grid (equation
// 2).
//
//     minimise over the pose:  sum_j (1 - M(T p_j))^2 / s^2  +  (x - x_prior)^T P^-1 (x - x_prior)
//
// Here s is the standard deviation of one point's score, T the pose x as a transform, and P the covariance of
// the prior. The information matrix of the match is J^T J / s^2, the Gauss-Newton approximation of the second
// derivative. In a corridor, this matrix is nearly singular.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <optional>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

struct RefinementOptions {
  int max_iterations = 12;
  double score_sigma = 0.5;  ///< standard deviation s of a point's score, enlarged for correlated neighbours
  /// Length of a step that ends the iteration. A step that lowers the cost must also turn by less than a
  /// tenth of this value, in radians.
  double converged_step_m = 2e-4;
  double max_shift_m = 0.15;  ///< refine() returns the start if the pose moved farther, to another peak
};

/// Pose known from other sources than the scan, such as odometry.
struct PosePrior {
  mrpt::math::TPose2D map_T_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of (x, y, theta), along the map's axes
};

struct RefinedPose {
  mrpt::math::TPose2D map_T_robot;
  double mean_score = 0;                                  ///< mean score of the points, in [0, 1]
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< from the scan alone, without the prior
  int iterations = 0;
};

/// Refines the pose `map_T_robot`. Without `known`, the prior is the start pose with a standard deviation of
/// 0.15 m in position. Without any prior, noise would move the pose along a corridor.
RefinedPose refine(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot,
                   const RefinementOptions& options, const std::optional<PosePrior>& known = {});

/// Inverts an information matrix. Limits the standard deviations along its principal axes to [min_sigma_m,
/// max_sigma_m], so a singular matrix is allowed. For the limits, angles are multiplied by `lever_m`.
Eigen::Matrix3d bounded_covariance(const Eigen::Matrix3d& information, double min_sigma_m, double max_sigma_m,
                                   double lever_m);

}  // namespace psi_slam
