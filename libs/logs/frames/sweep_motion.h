// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Returns the robot's motion during a sweep of `sweep_s` seconds, of either sign, if the robot made `motion`
/// in `duration_s` seconds at a constant velocity. Empty if the sweep time is 0, if the duration is not
/// positive or longer than a second, or if the sweep takes more than 1.5 times as long as the motion, because
/// the sweep time is wrong then.
std::optional<mrpt::math::TPose2D> motion_during_sweep(const mrpt::math::TPose2D& motion, double duration_s,
                                                       double sweep_s);

/// Deskews all scans of a frame, see deskewed(). `motion` is the motion of the robot within `duration_s`
/// seconds. Leaves scans unchanged whose motion_during_sweep() is unknown. Returns whether it deskewed any
/// scan.
bool straighten(Frame& frame, const mrpt::math::TPose2D& motion, double duration_s);

}  // namespace psi_slam
