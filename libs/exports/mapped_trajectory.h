// SPDX-License-Identifier: BSD-3-Clause
// Where a finished map has the robot, scan by scan.
#pragma once

#include <vector>

#include "psi_slam/mapping_result.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

/// In the map's frame, one pose for each frame in their order.
Trajectory trajectory_of(const std::vector<FrameRecord>& frames);

}  // namespace psi_slam
