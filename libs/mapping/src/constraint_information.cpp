// SPDX-License-Identifier: BSD-3-Clause
#include "constraint_information.h"

#include <Eigen/LU>

namespace psi_slam {

Eigen::Matrix3d information_of(const Eigen::Matrix3d& covariance, double sigma_m, double sigma_rad) {
  Eigen::Matrix3d sum = covariance;
  sum.diagonal() += Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  const Eigen::Matrix3d information = sum.inverse();
  return 0.5 * (information + information.transpose());
}

}  // namespace psi_slam
