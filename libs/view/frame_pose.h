// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>

#include "replay/replay_snapshot.h"

namespace psi_slam {

/// Where the robot was at a scan, in the map as it is now: as the result has it, and before that as the front
/// end saw it from the node before.
mrpt::math::TPose2D map_T_frame(const ReplaySnapshot& snapshot, std::size_t frame);

}  // namespace psi_slam
