// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Removes the robot's motion during the sweeps from all scans of a frame, see deskewed(). The robot made
/// `motion` in `duration_s` seconds at a constant velocity. Leaves scans without sweep time unchanged, and
/// scans whose sweep takes more than 1.5 times as long as the motion, because their sweep time is wrong.
/// Returns whether any scan was straightened.
bool straighten(Frame& frame, const mrpt::math::TPose2D& motion, double duration_s);

}  // namespace psi_slam
