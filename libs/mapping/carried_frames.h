// SPDX-License-Identifier: BSD-3-Clause
// Where the scans between the nodes of the graph are, once the nodes have their places.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Sets `map_T_robot` of every frame: as the front end saw it from the node before and from the node behind,
/// in between the two in proportion. `node_frames` is the frame of each node, `later_run_frames` the first frame
/// of each drive behind the first: the front end's frame is another from there on.
void carry_frames_along(const std::vector<mrpt::math::TPose2D>& map_T_node,
                        const std::vector<std::size_t>& node_frames, std::vector<FrameRecord>& frames,
                        const std::vector<std::size_t>& later_run_frames = {});

}  // namespace psi_slam
