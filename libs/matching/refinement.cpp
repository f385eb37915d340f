// SPDX-License-Identifier: BSD-3-Clause
#include "matching/refinement.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "matching/refinement_kernel.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// The cost at one pose, and its Gauss-Newton approximation around that pose.
struct Linearisation {
  double cost = 0;
  double mean_score = 0;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // information of the scan alone
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();      // information of the scan and the prior
  Eigen::Vector3d descent = Eigen::Vector3d::Zero();
};

Linearisation linearise(const ScoreGrid& grid, const ScanPoints& scan, const TPose2D& pose,
                        double score_sigma, const PosePrior& prior) {
  const ScoreSums sums = refinement_kernel()(placed(grid, scan, pose));

  Linearisation result;
  const double weight = 1 / (score_sigma * score_sigma);
  result.cost = weight * sums.squares;
  result.mean_score = sums.scores / static_cast<double>(std::max<std::size_t>(1, scan.points.size()));
  result.information << sums.xx, sums.xy, sums.x_phi,  //
      sums.xy, sums.yy, sums.y_phi,                    //
      sums.x_phi, sums.y_phi, sums.phi_phi;
  result.information *= weight;
  result.descent = weight * Eigen::Vector3d(sums.x, sums.y, sums.phi);
  result.hessian = result.information;
  const Eigen::Vector3d off(prior.map_T_robot.x - pose.x, prior.map_T_robot.y - pose.y,
                            mrpt::math::wrapToPi(prior.map_T_robot.phi - pose.phi));
  result.hessian += prior.information;
  result.descent += prior.information * off;
  result.cost += off.dot(prior.information * off);
  return result;
}

// Returns the default prior, at the start pose. It suppresses noise in directions that the scan does not
// determine, as along a corridor.
PosePrior held_at(const TPose2D& map_T_robot) {
  constexpr double kSigma_m = 0.15;
  PosePrior prior;
  prior.map_T_robot = map_T_robot;
  prior.information.diagonal().head<2>().setConstant(1 / (kSigma_m * kSigma_m));
  return prior;
}

}  // namespace

RefinedPose refine(const ScoreGrid& grid, const ScanPoints& scan, const TPose2D& map_T_robot,
                   const RefinementOptions& options, const std::optional<PosePrior>& known) {
  const PosePrior prior = known ? *known : held_at(map_T_robot);
  TPose2D pose = map_T_robot;
  Linearisation here = linearise(grid, scan, pose, options.score_sigma, prior);
  const Linearisation start = here;
  double damping = 1e-4;
  int iterations = 0;
  while (iterations < options.max_iterations) {
    ++iterations;
    // Small additional damping keeps rounding errors from moving the pose where the scan does not determine
    // it.
    const double least = 1e-6 * (1 + std::max(here.hessian(0, 0), here.hessian(1, 1)));
    const Eigen::Vector3d undetermined(least, least, 1e-6 * (1 + here.hessian(2, 2)));
    Eigen::Matrix3d damped = here.hessian;
    damped.diagonal() += damping * here.hessian.diagonal() + undetermined;
    const Eigen::Vector3d step = damped.ldlt().solve(here.descent);
    if (!step.allFinite()) break;
    TPose2D next(pose.x + step.x(), pose.y + step.y(), pose.phi + step.z());
    next.normalizePhi();
    const Linearisation there = linearise(grid, scan, next, options.score_sigma, prior);
    if (there.cost < here.cost) {
      pose = next;
      here = there;
      damping *= 0.1;
      const double moved_m = portable::hypot(step.x(), step.y());
      if (moved_m < options.converged_step_m && std::abs(step.z()) < 0.1 * options.converged_step_m) break;
    } else {
      if (step.head<2>().norm() < options.converged_step_m) break;
      damping = std::max(damping * 20, 1e-3);
    }
  }
  if (portable::hypot(pose.x - map_T_robot.x, pose.y - map_T_robot.y) > options.max_shift_m) {
    return {map_T_robot, start.mean_score, start.information, iterations};
  }
  return {pose, here.mean_score, here.information, iterations};
}

Eigen::Matrix3d bounded_covariance(const Eigen::Matrix3d& information, double min_sigma_m, double max_sigma_m,
                                   double lever_m) {
  const Eigen::Vector3d scale(1, 1, 1 / lever_m);  // converts radians to metres at the end of the lever
  const Eigen::Matrix3d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scaled);
  Eigen::Vector3d variances;
  for (int i = 0; i < 3; ++i) {
    const double floor = 1 / (max_sigma_m * max_sigma_m);
    variances[i] = std::max(1 / std::max(axes.eigenvalues()[i], floor), min_sigma_m * min_sigma_m);
  }
  const Eigen::Matrix3d covariance =
      axes.eigenvectors() * variances.asDiagonal() * axes.eigenvectors().transpose();
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

}  // namespace psi_slam
