// SPDX-License-Identifier: BSD-3-Clause
// Disabled loops that agree with each other. A few false loops that close a long ring first contradict all
// true loops of the ring. The true ones then agree how far the map is off there, and false ones rarely do.
#pragma once

#include <cstddef>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Moves of the later node within these distances agree.
inline constexpr double kSameMove_m = 0.5;
inline constexpr double kSameTurn_rad = 0.1;

/// Returns the places in `loops` of the largest set of disabled loops that agree: from the pose of its
/// earlier node, each moves the later node alike in the map, within about kSameMove_m along each axis and
/// kSameTurn_rad.
std::vector<std::size_t> rival_loops(const PoseGraph& graph, const std::vector<std::size_t>& loops);

}  // namespace psi_slam
