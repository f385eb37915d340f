// SPDX-License-Identifier: BSD-3-Clause
// Finds loops that the rest of the graph contradicts. A false loop bends the graph, so that true loops nearby
// look wrong. Therefore the worst loops are disabled first, then the graph is optimised, until no loop is
// contradicted. Disabled loops that fit in the end are enabled.
//
// If many loops are contradicted, false loops may outnumber true ones, and the worst need not be false. Then
// select_inlier_loops() selects consistent loops first.
#pragma once

#include <cstddef>
#include <vector>

#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Share of contradicted loops above which select_inlier_loops() is needed.
inline constexpr double kDoubtfulShare = 0.2;

/// Optimises the graph. Enables and disables the constraints `loops` so that no enabled one has a residual
/// above `max_chi` standard deviations. Returns the residuals in the order of `loops`. With a
/// `doubtful_share` of 1 it never calls select_inlier_loops().
std::vector<double> switch_off_outlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                                             const std::vector<std::size_t>& loops, double max_chi,
                                             double doubtful_share = kDoubtfulShare);

/// Largest residual against the path without loops, in units of `max_chi`. Generous, because the front end
/// may underestimate its errors.
inline constexpr double kPathGate = 3;

/// Selects consistent loops when most of them may be false. Starts from the graph without loops: a loop that
/// contradicts it by far more than the uncertainty along the path is false. Graduated non-convexity decides
/// among the remaining loops.
///
/// Enables those of the constraints `loops` that agree within `max_chi` standard deviations, and disables the
/// others. Ignores the graph's poses and which loops were enabled before. Leaves the graph optimised with the
/// enabled loops. Throws UserError if the other constraints do not connect all nodes.
void select_inlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                         const std::vector<std::size_t>& loops, double max_chi);

/// Residual of each of the disabled loops at the graph's poses, in standard deviations. The uncertainty is
/// that of the best path between the loop's nodes and that of the loop.
std::vector<double> path_chi(const PoseGraph& graph, const std::vector<std::size_t>& loops);

}  // namespace psi_slam
