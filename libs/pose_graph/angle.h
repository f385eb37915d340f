// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace psi_slam {

inline constexpr double kPi = 3.14159265358979323846;

/// The same angle in (-pi, pi]; radians.
inline double wrap_to_pi(double angle) {
  if (angle > -kPi && angle <= kPi) return angle;
  const double wrapped = std::remainder(angle, 2 * kPi);
  return wrapped > -kPi ? wrapped : kPi;
}

}  // namespace psi_slam
