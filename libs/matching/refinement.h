// SPDX-License-Identifier: BSD-3-Clause
// Below a cell: Levenberg-Marquardt on the smoothly interpolated score grid, from the best pose of the
// lattice.
//
//     minimise over the pose:  sum_j (1 - M(T p_j))^2 / s^2  +  (x - x_prior)^T P^-1 (x - x_prior)
//
// with s the standard deviation of one point's score. The information matrix of the match is J^T J / s^2, its
// second derivative by Gauss-Newton; along a corridor it is nearly singular, and says so.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <optional>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

struct RefinementOptions {
  int max_iterations = 12;
  double score_sigma = 0.5;  ///< s: how far a point's score strays from 1, and neighbours stray together
  double converged_step_m = 2e-5;  ///< stop at steps below this, and below the same in radians times 0.1
  double max_shift_m = 0.15;       ///< farther from the start it is another peak: the start is returned
};

/// What is known of the pose besides the scan: odometry, for one.
struct PosePrior {
  mrpt::math::TPose2D map_T_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< order x, y, theta
};

struct RefinedPose {
  mrpt::math::TPose2D map_T_robot;
  double mean_score = 0;                                  ///< of the points at map_T_robot, in [0, 1]
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan alone, without the prior
  int iterations = 0;
};

/// Without anything known, the start itself holds the position, with a standard deviation of 0.15 m: else
/// noise would carry the pose along a corridor.
RefinedPose refine(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot,
                   const RefinementOptions& options, const std::optional<PosePrior>& known = {});

/// The covariance that belongs to an information matrix, with standard deviations bounded to [min, max] along
/// its principal axes, so that a singular one stays usable. Units m and rad share the bounds, radians scaled
/// by `lever_m` metres.
Eigen::Matrix3d bounded_covariance(const Eigen::Matrix3d& information, double min_sigma_m, double max_sigma_m,
                                   double lever_m);

}  // namespace psi_slam
