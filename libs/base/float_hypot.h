// SPDX-License-Identifier: BSD-3-Clause
// Length of a vector of floats that is the same with every C library and on every processor.
#pragma once

#include <cmath>

namespace psi_slam {

/// Returns √(x² + y²). Computes it in double by operations that IEEE 754 defines to the last bit. hypotf()
/// and the other functions of <cmath> for floats differ in the last bit between versions of the C library.
inline float float_hypot(float x, float y) {
  const auto wide_x = static_cast<double>(x);
  const auto wide_y = static_cast<double>(y);
  return static_cast<float>(std::sqrt(wide_x * wide_x + wide_y * wide_y));
}

}  // namespace psi_slam
