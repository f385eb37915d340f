// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace psi_slam {

/// A cell of a score grid, or a distance in cells.
struct Cell {
  std::int32_t x;
  std::int32_t y;
};

/// Returns the largest integer not above `value`, which must fit an int. Faster than std::floor, which is a
/// library call on baseline x86-64. Always inlined, because kernels for other instruction sets use it.
__attribute__((always_inline)) inline int floor_to_int(double value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < towards_zero ? 1 : 0);
}
__attribute__((always_inline)) inline int floor_to_int(float value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < static_cast<float>(towards_zero) ? 1 : 0);
}

}  // namespace psi_slam
