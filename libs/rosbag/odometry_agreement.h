// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Returns how much the motions between scans of one laser, by their alignment, differ from odometry: the
/// median over the first 200 steps of about 0.1 m or 5 degrees, metres at 2 m from the robot. Infinity if
/// fewer than 10 steps can be aligned. Ends at the first error of the log.
double disagreement_with_odometry_m(FrameSource& scans);

}  // namespace psi_slam
