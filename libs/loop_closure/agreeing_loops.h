// SPDX-License-Identifier: BSD-3-Clause
// Disabled loops that agree with each other. A few false loops can close a long ring before the true ones do.
// They then contradict all true loops of the ring, and these agree how far that part of the map is off. False
// loops agree by chance if they are thousands, or if similar places were matched again and again.
#pragma once

#include <cstddef>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Returns the indices into `loops`, ascending, of the largest set of disabled loops that agree. Each of them
/// moves its later node, seen from its earlier node, alike along the axes of the map: the moves of a set lie
/// within 1.5 m, and within 0.3 rad. Loops that would move it less than 0.75 m and 0.15 rad are left out,
/// because they nearly fit.
std::vector<std::size_t> agreeing_loops(const PoseGraph& graph, const std::vector<std::size_t>& loops);

}  // namespace psi_slam
