// SPDX-License-Identifier: BSD-3-Clause
// Poses of the scans between the nodes of the graph.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Sets `map_T_robot` of every frame. Applies the front end's motion to the previous and the next node's
/// pose, and interpolates between the two results by frame number. `node_frames` has the frame of each node.
/// `later_run_frames` has the first frame of each later run; no interpolation reaches across it.
void carry_frames_along(const std::vector<mrpt::math::TPose2D>& map_T_node,
                        const std::vector<std::size_t>& node_frames, std::vector<FrameRecord>& frames,
                        const std::vector<std::size_t>& later_run_frames = {});

}  // namespace psi_slam
