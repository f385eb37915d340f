// SPDX-License-Identifier: BSD-3-Clause
// Error of a path against the truth that does not depend on the frame of either.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

namespace psi_slam {

/// Mean distance, in metres, between two paths of the same frames after the rigid alignment that minimises
/// the sum of squared distances (Umeyama, 1991, without scale). The paths must not be empty.
double aligned_error_m(const std::vector<mrpt::math::TPose2D>& path,
                       const std::vector<mrpt::math::TPose2D>& truth);

}  // namespace psi_slam
