// SPDX-License-Identifier: BSD-3-Clause
// Rejects loops that the rest of the graph contradicts: by graduated non-convexity over the whole graph, and
// by nothing else. It runs twice. First the path is doubtful, see doubtful_graph(). It then bends
// where loops that agree with each other say so, also if its error is the same along the whole path, and a
// false loop stands alone against the path and the other loops. Then the path, which the other loops have
// bent, is as certain as it states, and contradicts the loops that are a little false.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Rejects outlier loops. First optimises the graph with all constraints `loops`, and keeps all of them if no
/// residual exceeds kInlierChi. Otherwise minimises the error sum with a kernel that bounds the cost of each
/// loop, see optimize_graduated(), and disables the loops whose residual then exceeds kInlierChi. Does so
/// twice: with an uncertain path, and from this result with a certain path. Then optimises the graph with the
/// remaining loops, and enables disabled loops that fit the result. Loops by hand have kernels of their own;
/// they are not among `loops` and always act on the path. Returns the residuals in the order of `loops`, in
/// standard deviations.
std::vector<double> reject_outlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                                         const std::vector<std::size_t>& loops);

/// Returns how far a constraint is from the poses of a graph without it, in standard deviations of both: the
/// constraint's, and those of the graph by graph_with_shared_errors(). Empty if the constraints of the graph
/// do not determine all poses.
std::optional<double> contradiction(const Constraint& constraint, const PoseGraph& rest);

}  // namespace psi_slam
