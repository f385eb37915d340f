// SPDX-License-Identifier: BSD-3-Clause
// What the window shows of one loop: a picture of the match, and the loop's residual in the graph.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "rendering/map_image.h"
#include "replay/replay_snapshot.h"

namespace psi_slam {

/// The local map of a loop and the node's scan on it; both in the local map's frame.
struct LoopPicture {
  MapRaster local_map;                       ///< white, dark where scans hit something
  std::vector<mrpt::math::TPoint2D> before;  ///< the scan at the predicted pose
  std::vector<mrpt::math::TPoint2D> after;   ///< the scan at the matched pose; empty without a match
};

/// Picture of a loop by its index; nothing if the snapshot lacks the loop, its local map or its node.
std::optional<LoopPicture> loop_picture(const ReplaySnapshot& snapshot, std::size_t loop);

/// Error of a loop in the present graph: from the matched pose of the node to its pose in the graph.
struct LoopResidual {
  double distance_m = 0;
  double turn_rad = 0;  ///< absolute value
};

LoopResidual loop_residual(const LoopRecord& loop, const std::vector<mrpt::math::TPose2D>& map_T_node);

}  // namespace psi_slam
