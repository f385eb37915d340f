// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/doubtful_corrections.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

constexpr double kWeight = 0.02;      // weight of one correction in the mean of squared ratios
constexpr double kLargestSquare = 9;  // squared ratios count as at most this multiple of their mean

}  // namespace

void DoubtfulCorrections::moved(double length_m, std::optional<double> sigma_m) {
  sum_m_ *= portable::exp(-length_m / options_.travel_m);
  step_sigma_m_ = sigma_m.value_or(0);
  variance_m2_ += sigma_m ? *sigma_m * *sigma_m : std::numeric_limits<double>::infinity();
}

void DoubtfulCorrections::add_supported(double correction_m) {
  if (variance_m2_ > 0 && std::isfinite(variance_m2_)) {
    const double square = correction_m * correction_m / variance_m2_;
    mean_square_ += kWeight * (std::min(square, kLargestSquare * std::max(1.0, mean_square_)) - mean_square_);
  }
  variance_m2_ = 0;
}

bool DoubtfulCorrections::add_doubtful(const Eigen::Vector2d& correction_m) {
  const Eigen::Vector2d sum_m = sum_m_ + correction_m;
  if (correction_m.norm() > options_.max_sigmas * sigma_m()) return false;
  if (sum_m.norm() > std::max(max_sum_m(), sum_m_.norm())) return false;
  sum_m_ = sum_m;
  variance_m2_ = 0;
  return true;
}

double DoubtfulCorrections::scale() const {
  return std::sqrt(std::max(1.0, mean_square_));
}

double DoubtfulCorrections::sigma_m() const {
  return scale() * std::sqrt(variance_m2_);
}

double DoubtfulCorrections::max_sum_m() const {
  return scale() * std::max(options_.max_sum_m, options_.max_sigmas * step_sigma_m_);
}

}  // namespace psi_slam
