// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace psi_slam {

/// The inverse of a covariance (m, m, rad) with noise of its own added: an information matrix as constraints
/// take it.
Eigen::Matrix3d information_of(const Eigen::Matrix3d& covariance, double sigma_m, double sigma_rad);

}  // namespace psi_slam
