// SPDX-License-Identifier: BSD-3-Clause
// Which loops to trust when most of them may be false. It begins with what no loop has touched: the graph
// without any. A loop that contradicts it by far more than its uncertainty along the path allows is false
// whatever the others say; among those that are left the others decide, by graduated non-convexity.
#pragma once

#include <cstddef>
#include <vector>

#include "psi_slam/pose_graph.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

/// Of the path alone, in units of `max_chi`: generous, since the front end may err by more than it thinks.
inline constexpr double kPathGate = 3;

/// Switches on those of the constraints `loops` that fit together within `max_chi` standard deviations, the
/// others off, whichever were on before. Where the graph's poses were does not matter: they begin as its
/// other constraints alone say, and end optimised by the loops that are on. Throws UserError when those
/// others do not link all nodes.
void trust_loops(PoseGraph& graph, SparsePoseAdjustment& solver, const std::vector<std::size_t>& loops,
                 double max_chi);

/// By how many standard deviations the enabled constraints contradict each of the loops, which are off, at
/// the graph's poses: the uncertainty is that along the best path between its ends and the loop's own.
std::vector<double> path_chi(const PoseGraph& graph, const std::vector<std::size_t>& loops);

}  // namespace psi_slam
