// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace psi_slam {

/// Converts degrees to the nearest double in radians. Computes in long double, as parse_degrees() does.
/// Defaults in code therefore equal the values in settings files and print as round degrees.
constexpr double radians_from_degrees(long double degrees) {
  constexpr long double kPi = 3.141592653589793238462643383279502884L;
  return static_cast<double>(degrees * kPi / 180);
}

}  // namespace psi_slam
