// SPDX-License-Identifier: BSD-3-Clause
// Poses of the scans between the nodes of the graph.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Sets `map_T_robot` of every frame. Applies the front end's motion to the pose of the node before the frame
/// and of the node after it. Interpolates between the two results by frame number. `node_frames` holds the
/// frame number of each node. `later_run_frames` holds the first frame of each later run; no interpolation
/// crosses the start of a run.
void carry_frames_along(const std::vector<mrpt::math::TPose2D>& map_T_node,
                        const std::vector<std::size_t>& node_frames, std::vector<FrameRecord>& frames,
                        const std::vector<std::size_t>& later_run_frames = {});

}  // namespace psi_slam
