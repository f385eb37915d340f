// SPDX-License-Identifier: BSD-3-Clause
// Bins of bearings, for range images.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace psi_slam {

inline constexpr std::size_t kBearingBins = 360;

/// Returns the bin of the bearing of a point: bin i holds the bearings from i to i + 1 degrees. A point
/// within 0.001 degrees of an edge may be in the bin on the other side, because the arctangent is a
/// polynomial that is off by up to 1.2e-5 rad (Hastings 1955). Points at the origin or at infinity are in bin
/// 0.
inline std::size_t bearing_bin(double x, double y) {
  const double across = std::abs(x);
  const double along = std::abs(y);
  const double larger = std::max(across, along);
  if (!(larger > 0 && std::isfinite(larger))) return 0;
  const double slope = std::min(across, along) / larger;
  const double square = slope * slope;
  double angle_rad =
      slope *
      (0.9998660 + square * (-0.3302995 + square * (0.1801410 + square * (-0.0851330 + square * 0.0208351))));
  if (along > across) angle_rad = M_PI / 2 - angle_rad;
  if (x < 0) angle_rad = M_PI - angle_rad;
  if (y < 0) angle_rad = 2 * M_PI - angle_rad;
  return std::min(static_cast<std::size_t>(angle_rad * (kBearingBins / (2 * M_PI))), kBearingBins - 1);
}

}  // namespace psi_slam
