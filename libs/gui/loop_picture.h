// SPDX-License-Identifier: BSD-3-Clause
// Details of one loop for the window: an image of the match, and the loop's residual in the graph.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "gui/replay_snapshot.h"
#include "map/rendering/map_image.h"

namespace psi_slam {

/// The local map of a loop, and the node's scan at two poses; all in the local map's frame.
struct LoopPicture {
  MapRaster local_map;                       ///< white, dark where the scans of the local map have returns
  std::vector<mrpt::math::TPoint2D> before;  ///< the scan at the predicted pose
  std::vector<mrpt::math::TPoint2D> after;   ///< the scan at the matched pose; empty without a match
};

/// Returns the picture of the loop with this index in ReplaySnapshot::loops; nothing if the snapshot lacks
/// the loop, its local map or its node.
std::optional<LoopPicture> loop_picture(const ReplaySnapshot& snapshot, std::size_t loop);

/// Error of a loop in the current graph, in metres: distance from the matched position of the node to its
/// position in the graph.
double loop_residual_m(const LoopRecord& loop, const std::vector<mrpt::math::TPose2D>& map_T_node);

}  // namespace psi_slam
