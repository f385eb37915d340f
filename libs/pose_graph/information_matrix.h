// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "base/portable_math.h"

namespace psi_slam {

/// Returns whether the matrix can be an inverse covariance: finite and, up to rounding, symmetric and
/// positive semi-definite.
inline bool is_information_matrix(const Eigen::Matrix3d& information) {
  if (!information.allFinite()) return false;
  const double scale = information.cwiseAbs().maxCoeff();
  if (!(information - information.transpose()).isZero(1e-9 * scale)) return false;
  if (information.diagonal().minCoeff() < 0) return false;
  // Checks correlations instead of entries, so that the units of x, y and theta do not matter.
  const Eigen::Vector3d norm = information.diagonal().cwiseSqrt();
  const auto correlation = [&](int row, int column) {
    const double entry = information(row, column);
    return entry == 0 ? 0.0 : entry / (norm[row] * norm[column]);
  };
  const double xy = correlation(0, 1);
  const double xt = correlation(0, 2);
  const double yt = correlation(1, 2);
  constexpr double kRounding = 3e-5;  // rounding of entries in text files with six digits
  const double limit = 1 + kRounding;
  const double determinant = 1 + 2 * xy * xt * yt - xy * xy - xt * xt - yt * yt;
  return xy * xy <= limit && xt * xt <= limit && yt * yt <= limit && determinant >= -kRounding;
}

/// Returns R M Rᵀ, where R turns x and y by `angle_rad`: converts a covariance or information matrix of (x,
/// y, theta) from the axes of a frame b to those of a frame a, in which b has this heading.
inline Eigen::Matrix3d in_turned_axes(const Eigen::Matrix3d& matrix, double angle_rad) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation(0, 0) = rotation(1, 1) = portable::cos(angle_rad);
  rotation(1, 0) = portable::sin(angle_rad);
  rotation(0, 1) = -rotation(1, 0);
  return rotation * matrix * rotation.transpose();
}

/// Returns the inverse of a covariance of (x, y, theta) after adding independent noise to it: `sigma_m` in x
/// and y, `sigma_rad` in theta.
inline Eigen::Matrix3d noisy_information(const Eigen::Matrix3d& covariance, double sigma_m,
                                         double sigma_rad) {
  const Eigen::Vector3d noise(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  const Eigen::Matrix3d inverse = (covariance + Eigen::Matrix3d(noise.asDiagonal())).inverse();
  return (inverse + inverse.transpose()) / 2;
}

}  // namespace psi_slam
