// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/gyroscope_model.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>

namespace psi_slam {
namespace {

constexpr int kBiasScans = 20;        // the bias is a mean of the first scans, then a decaying mean
constexpr double kErrorWeight = 0.1;  // weight of one scan in the mean errors
// A wrong match changes the bias and the mean errors by limited amounts.
constexpr double kLargestBiasStep_radps = 0.2;
constexpr double kLargestError_rad = 0.2;
constexpr double kSmallError_rad = radians_from_degrees(1.0L);

void average(double& squared_mean, double error_rad) {
  const double limited_rad =
      std::clamp(mrpt::math::wrapToPi(error_rad), -kLargestError_rad, kLargestError_rad);
  squared_mean += kErrorWeight * (limited_rad * limited_rad - squared_mean);
}

}  // namespace

bool GyroscopeModel::is_credible() const {
  return squared_error_ <= squared_error_of_steady_turns_ + kSmallError_rad * kSmallError_rad;
}

void GyroscopeModel::learn(double passed_s, double measured_rad, double matched_rad, double steady_rad) {
  const double error_rad = mrpt::math::wrapToPi(turn_rad(measured_rad, passed_s) - matched_rad);
  average(squared_error_, error_rad);
  average(squared_error_of_steady_turns_, steady_rad - matched_rad);
  learned_scans_ = std::min(learned_scans_ + 1, kBiasScans);
  bias_radps_ +=
      std::clamp(error_rad / passed_s, -kLargestBiasStep_radps, kLargestBiasStep_radps) / learned_scans_;
}

}  // namespace psi_slam
