// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>

#include "logs/frames/pose_operations.h"

namespace psi_slam {

/// Largest differences of two poses at one place.
struct PoseTolerance {
  double metres = 0;
  double radians = 0;
};

/// Returns whether distance and turn between two poses are within the tolerance.
inline bool is_same_place(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b,
                          const PoseTolerance& tolerance) {
  return distance_m(b, a) <= tolerance.metres &&
         std::abs(mrpt::math::wrapToPi(a.phi - b.phi)) <= tolerance.radians;
}

}  // namespace psi_slam
