// SPDX-License-Identifier: BSD-3-Clause
// Frames whose scans repeat earlier scans may lose their ranges. Their times, odometry and mounts remain.
#pragma once

#include "psi_slam/frame.h"

namespace psi_slam {

/// Frees the ranges and bearings of all scans of a frame.
void discard_ranges(Frame& frame);

/// Returns whether any scan of a frame has a range, valid or not.
bool has_ranges(const Frame& frame);

}  // namespace psi_slam
