// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

namespace psi_slam {

/// Returns b_T_a for a_T_b. MRPT has this function for CPose2D only.
inline mrpt::math::TPose2D inverse(const mrpt::math::TPose2D& a_T_b) {
  return mrpt::math::TPose2D(0, 0, 0) - a_T_b;
}

}  // namespace psi_slam
