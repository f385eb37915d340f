// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace psi_slam {

/// The radians nearest to an angle in degrees: computed with long doubles, so that it is the same number that
/// the settings' parser makes of the same degrees, and is printed as round as it was written.
constexpr double radians_from_degrees(long double degrees) {
  constexpr long double kPi = 3.141592653589793238462643383279502884L;
  return static_cast<double>(degrees * kPi / 180);
}

}  // namespace psi_slam
