// SPDX-License-Identifier: BSD-3-Clause
// Optimises a graph in which unknown loop constraints are false, by graduated non-convexity (Yang, Antonante,
// Tzoumas, Carlone, "Graduated non-convexity for robust spatial perception", RA-L 2020) with the
// Geman-McClure kernel. It begins with a kernel so wide that E is almost the plain sum, and narrows it from
// solve to solve, so that constraints that contradict the others lose weight one after another. With many
// false constraints, the narrow kernel from the given poses can end at a lower E; the lower solution is used.
#pragma once

#include <cstddef>
#include <vector>

#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct GraduatedOptions {
  double inlier_width = 3.37;  ///< in standard deviations: root of the 99 % quantile of chi-square, 3 dof
  double narrowing = 1.2;      ///< > 1: factor by which the squared width falls per round
  int max_rounds = 200;
  int first_iterations = 10;  ///< iterations of the solve with the widest kernel
  int iterations_per_round = 2;
};

struct GraduatedReport {
  /// Solution at the inlier width, with the iterations of the last solve and the time of all solves.
  PoseAdjustmentReport solution;
  int rounds = 0;  ///< solves between the widest kernel and the inlier width
  /// Enabled constraints of the kind kLoop beyond the inlier width, ascending.
  std::vector<std::size_t> outliers;
};

/// Moves the poses of the graph and leaves its constraints unchanged. During the call, the kernel replaces
/// that of the solver for loops; constraints with their own kernel keep it. Throws as
/// SparsePoseAdjustment::optimize().
GraduatedReport optimize_graduated(PoseGraph& graph, SparsePoseAdjustment& solver,
                                   const GraduatedOptions& options = {});

}  // namespace psi_slam
