// SPDX-License-Identifier: BSD-3-Clause
// Checks covariances: the normalised error e^T C^-1 e follows the chi-square distribution with three degrees
// of freedom if C is the covariance of the error e (Bar-Shalom's test of consistency).
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "map/trajectory/trajectory_file.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Median and 95 % point of the chi-square distribution with three degrees of freedom.
inline constexpr double kChiSquareMedian = 2.366;
inline constexpr double kChiSquare95 = 7.815;

/// Normalised squared errors of one kind of poses.
struct NormalisedErrors {
  std::string of;  ///< kind of the poses: "scans in local maps", ...
  std::size_t count = 0;
  /// Divided by 3: 1 for correct covariances, 4 if the standard deviations are half the true ones.
  double mean = 0;
  double median = 0;     ///< divided by kChiSquareMedian: 1 for correct covariances, robust to outliers
  double beyond_95 = 0;  ///< share above kChiSquare95: 0.05 for correct covariances
};

/// e^T Omega e of equation 5 between a measured relative pose and the true one.
double normalised_square(const mrpt::math::TPose2D& measured, const mrpt::math::TPose2D& truth,
                         const Eigen::Matrix3d& information);

/// Statistics of the normalised squared errors `squares`; zeros without squares. `of` names the kind of
/// poses.
NormalisedErrors normalised_errors(std::string of, std::vector<double> squares);

/// Normalised errors of the local-map constraints, of the loops, and of random pairs of nodes. The covariance
/// of pairs is computed in three ways: along the best path between the nodes, as in the loop search; from the
/// whole graph with independent constraints; and from the whole graph with the errors that constraints share,
/// see graph_with_shared_errors(). The last way is also checked for nodes close to each other on the path,
/// and for nodes relative to the first one, as trajectory.csv states it. The poses of the last three are
/// those of the result; the other pairs come from the graph optimised without the final scan refinement.
/// `truth` has a pose for each frame.
std::vector<NormalisedErrors> check_covariances(const MappingResult& result, const Trajectory& truth,
                                                std::uint64_t seed);

}  // namespace psi_slam
