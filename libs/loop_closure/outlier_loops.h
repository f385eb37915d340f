// SPDX-License-Identifier: BSD-3-Clause
// Finds outlier loops, which the rest of the graph contradicts. A false loop distorts the graph, so true
// loops nearby get large residuals too. Therefore only the loops with the largest residuals are disabled
// before the graph is optimised again. This step repeats until no enabled loop is contradicted. Disabled
// loops that then fit are enabled again.
//
// A few true loops that close a long ring may get large residuals too. The solver takes the errors along the
// ring for independent, so it leaves too much of the ring's error to the loops. Therefore a loop is only an
// outlier if its residual in the graph without it also exceeds the uncertainty along the path.
//
// If many loops are contradicted, false loops may outnumber true ones, and the loop with the largest residual
// need not be false. Then select_inlier_loops() selects consistent loops first.
//
// Then the disabled loops may be right and a few enabled ones false, if the loops of many nodes agree, see
// agreeing_loops(). They are tried instead of those that contradict them.
//
// Finally, if many loops are disabled, the front end's path may be bent and far less certain than it states.
// Then the loops that agree with each other along a less certain path are tried.
#pragma once

#include <cstddef>
#include <vector>

#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Share of contradicted loops above which select_inlier_loops() is needed.
inline constexpr double kDoubtfulShare = 0.2;

/// A loop with a path_chi() up to this share of `max_chi` is no outlier. With the default of 5, the limit is
/// 3.75 standard deviations, which 0.3 % of true loops exceed.
inline constexpr double kPlausibleShare = 0.75;

/// Smallest number of nodes of disabled loops that are tried instead of others. Fewer may all have been
/// matched with one wrong place.
inline constexpr std::size_t kFewestAgreeingNodes = 20;

/// Optimises the graph. Enables and disables the constraints `loops` until no enabled loop has a residual
/// above `max_chi` standard deviations and a path_chi() above kPlausibleShare * `max_chi`. Computes
/// path_chi() once, when no enabled loop is contradicted, of the loops that are then disabled. Loops that are
/// disabled after that stay disabled. Then repeats this with the loops of agreeing_loops() enabled, if they
/// are of enough nodes, and keeps the result if it enables more loops, by at least half of those that agree.
///
/// If more than `doubtful_share` of the loops are disabled in the end, and these are of enough nodes, calls
/// select_inlier_loops() with five times as large standard deviations of the front end's constraints. Enables
/// its loops if they are 95 % of all. These loops may have residuals above `max_chi`.
///
/// Returns the residuals in the order of `loops`. If `doubtful_share` is 1, never calls
/// select_inlier_loops(), which may throw UserError.
std::vector<double> switch_off_outlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                                             const std::vector<std::size_t>& loops, double max_chi,
                                             double doubtful_share = kDoubtfulShare);

/// Largest residual of an inlier loop in the graph without loops, in units of `max_chi`. The limit is wide,
/// because the front end may underestimate its errors.
inline constexpr double kPathGate = 3;

/// Selects consistent loops where most loops may be false. Starts from the graph without loops. A loop whose
/// residual far exceeds the uncertainty along the path is false. Graduated non-convexity decides among the
/// remaining loops.
///
/// Enables those of the constraints `loops` that agree within `max_chi` standard deviations, and disables the
/// others. The result depends neither on the graph's poses nor on which loops were enabled before. Leaves the
/// graph optimised with the enabled loops. Throws UserError if the other constraints do not connect all
/// nodes.
void select_inlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                         const std::vector<std::size_t>& loops, double max_chi);

/// Returns the residual of each loop at the graph's poses, in standard deviations; 0 if no path connects its
/// nodes. The covariance is the sum of the best path's and the loop's covariance. The loops must be disabled.
std::vector<double> path_chi(const PoseGraph& graph, const std::vector<std::size_t>& loops);

}  // namespace psi_slam
