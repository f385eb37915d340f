// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace psi_slam {

/// Returns the covariance of a weighted least-squares estimate from the scatter of its residuals, the
/// cluster-robust estimate of Liang and Zeger ("Longitudinal data analysis using generalized linear models",
/// 1986): H^-1 (sum over blocks of s s^T) H^-1. H is `hessian`, and s is the sum of the gradients of a block.
/// Blocks of consecutive equations allow for errors that neighbours share. `gradients` has weight times
/// Jacobian times residual of each equation, at the estimate and in the order of time. `prior_scatter` is the
/// covariance of the gradient of a prior.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> estimate_covariance(
    const Eigen::Matrix<double, kSize, kSize>& hessian,
    const std::vector<Eigen::Matrix<double, kSize, 1>>& gradients,
    const Eigen::Matrix<double, kSize, kSize>& prior_scatter) {
  constexpr std::size_t kMostInBlock = 10;
  constexpr std::size_t kBlocks = 20;  // fewest blocks, as far as there are equations
  const std::size_t in_block = std::clamp<std::size_t>(gradients.size() / kBlocks, 1, kMostInBlock);
  Eigen::Matrix<double, kSize, kSize> scatter = Eigen::Matrix<double, kSize, kSize>::Zero();
  std::size_t blocks = 0;
  for (std::size_t first = 0; first < gradients.size(); first += in_block, ++blocks) {
    Eigen::Matrix<double, kSize, 1> sum = Eigen::Matrix<double, kSize, 1>::Zero();
    for (std::size_t i = first; i < std::min(first + in_block, gradients.size()); ++i) sum += gradients[i];
    scatter += sum * sum.transpose();
  }
  // The estimate fits some of the noise, so the residuals are too small by the degrees of freedom it uses.
  const auto count = static_cast<double>(blocks);
  if (count > kSize) scatter *= count / (count - kSize);
  const Eigen::Matrix<double, kSize, kSize> inverse = hessian.inverse();
  return inverse * (scatter + prior_scatter) * inverse;
}

}  // namespace psi_slam
