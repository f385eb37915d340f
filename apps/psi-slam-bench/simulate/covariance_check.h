// SPDX-License-Identifier: BSD-3-Clause
// Whether covariances mean what they say: an error e divided by its covariance, e^T C^-1 e, follows the
// chi-square distribution of three degrees of freedom when C is the error's (Bar-Shalom's test of
// consistency).
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "psi_slam/mapping_result.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

/// Of the chi-square distribution of three degrees of freedom.
inline constexpr double kChiSquareMedian = 2.366;
inline constexpr double kChiSquare95 = 7.815;

/// Normalised squared errors of one kind of poses.
struct NormalisedErrors {
  std::string of;  ///< "scans in local maps", ...
  std::size_t count = 0;
  double mean = 0;       ///< over 3: 1 where the covariance is right, 4 where deviations are taken for half
  double median = 0;     ///< over kChiSquareMedian: as the mean, blind to the few worst
  double beyond_95 = 0;  ///< share above kChiSquare95: 0.05 where the covariance is right
};

/// e^T Omega e of equation 5 between a measured relative pose and the true one.
double normalised_square(const mrpt::math::TPose2D& measured, const mrpt::math::TPose2D& truth,
                         const Eigen::Matrix3d& information);

/// Zeros for no squares.
NormalisedErrors normalised_errors(std::string of, std::vector<double> squares);

/// Of the graph at its optimum, not of the poses refined after it: of the constraints in the finished graph,
/// local maps' and loops' apart, and of the poses of pairs of nodes drawn at random, by the best path, which
/// loops are looked for by, and by the whole graph. `truth` has a pose for each frame.
std::vector<NormalisedErrors> check_covariances(const MappingResult& result, const Trajectory& truth,
                                                std::uint64_t seed);

}  // namespace psi_slam
