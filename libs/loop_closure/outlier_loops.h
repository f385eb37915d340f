// SPDX-License-Identifier: BSD-3-Clause
// Which loops the rest of the graph contradicts. A false loop bends the graph, and true ones beside it look
// wrong then; so the worst are switched off first, the graph is optimised anew, and so on until none is
// contradicted; those that fit after all are switched on again.
//
// Where so many are contradicted that the false may outnumber the true, the worst are no longer the false
// ones. Then the graph begins anew without any loop, see trust_loops(), and goes on as above from there.
#pragma once

#include <cstddef>
#include <vector>

#include "psi_slam/pose_graph.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

/// Of the loops that are on, the share above which worst-first is not relied on.
inline constexpr double kDoubtfulShare = 0.2;

/// Optimises the graph and switches the constraints `loops`, on or off before, so that none that is on is
/// contradicted by more than `max_chi` standard deviations. Returns by how many each is, in their order. A
/// `doubtful_share` of 1 is worst-first only.
std::vector<double> switch_off_outlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                                                  const std::vector<std::size_t>& loops, double max_chi,
                                                  double doubtful_share = kDoubtfulShare);

}  // namespace psi_slam
