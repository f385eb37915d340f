// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace psi_slam {

/// A cell of a score grid, or a distance in cells.
struct Cell {
  std::int32_t x;
  std::int32_t y;
};

}  // namespace psi_slam
