// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace psi_slam {

/// Returns the covariance of an estimate from `count` measurements in the order of time, from the scatter of
/// the estimates that leave out one part of the log each (Efron and Stein, "The jackknife estimate of
/// variance", 1981). Parts are long, since errors are alike for as long as the robot stays at one place. An
/// estimate that depends on few parts scatters widely. `estimate_without(first, last)` returns the estimate
/// without the measurements [first, last).
template <int kSize, class EstimateWithout>
Eigen::Matrix<double, kSize, kSize> jackknife_covariance(std::size_t count,
                                                         const EstimateWithout& estimate_without) {
  constexpr std::size_t kParts = 20;
  std::vector<Eigen::Matrix<double, kSize, 1>> estimates;
  Eigen::Matrix<double, kSize, 1> mean = Eigen::Matrix<double, kSize, 1>::Zero();
  for (std::size_t part = 0; part < kParts; ++part) {
    estimates.push_back(estimate_without(part * count / kParts, (part + 1) * count / kParts));
    mean += estimates.back() / static_cast<double>(kParts);
  }
  Eigen::Matrix<double, kSize, kSize> scatter = Eigen::Matrix<double, kSize, kSize>::Zero();
  for (const auto& estimate : estimates) scatter += (estimate - mean) * (estimate - mean).transpose();
  return scatter * static_cast<double>(kParts - 1) / static_cast<double>(kParts);
}

}  // namespace psi_slam
