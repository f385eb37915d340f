// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace psi_slam {
namespace {

constexpr std::size_t kBins = 360;

}  // namespace

std::size_t RangeImage::bin(double bearing_rad) {
  const double turns = bearing_rad / (2 * M_PI);
  const auto index = static_cast<std::size_t>((turns - std::floor(turns)) * kBins);
  return std::min(index, kBins - 1);
}

RangeImage::RangeImage(const ScanPoints& scan)
    : origin_(scan.origin),
      nearest_m_(kBins, std::numeric_limits<float>::infinity()),
      farthest_m_(kBins, 0.0F) {
  for (const auto& point : scan.points) {
    const float dx = point.x - origin_.x;
    const float dy = point.y - origin_.y;
    const std::size_t b = bin(std::atan2(static_cast<double>(dy), static_cast<double>(dx)));
    const float range = std::hypot(dx, dy);
    nearest_m_[b] = std::min(nearest_m_[b], range);
    farthest_m_[b] = std::max(farthest_m_[b], range);
  }
}

RangeImage::Agreement RangeImage::compare(const ScanPoints& other, const mrpt::math::TPose2D& this_T_other,
                                          double tolerance_m) const {
  Agreement result;
  const double c = std::cos(this_T_other.phi);
  const double s = std::sin(this_T_other.phi);
  for (const auto& point : other.points) {
    const double x = this_T_other.x + c * static_cast<double>(point.x) - s * static_cast<double>(point.y);
    const double y = this_T_other.y + s * static_cast<double>(point.x) + c * static_cast<double>(point.y);
    const double dx = x - static_cast<double>(origin_.x);
    const double dy = y - static_cast<double>(origin_.y);
    const std::size_t b = bin(std::atan2(dy, dx));
    if (farthest_m_[b] <= 0) continue;
    const double range = std::hypot(dx, dy);
    if (range > static_cast<double>(farthest_m_[b]) + tolerance_m) continue;  // hidden
    if (range < static_cast<double>(nearest_m_[b]) - tolerance_m)
      ++result.contradict;
    else
      ++result.agree;
  }
  return result;
}

}  // namespace psi_slam
