// SPDX-License-Identifier: BSD-3-Clause
// Optimises a graph with false loops that are not known beforehand, by graduated non-convexity (Yang,
// Antonante, Tzoumas, Carlone, "Graduated non-convexity for robust spatial perception", RA-L 2020) with the
// Geman-McClure kernel. The first kernel is so wide that E is almost the plain sum of squared errors. Each
// further solve uses a narrower kernel, so constraints that contradict the others lose weight one after
// another. With many false constraints, a single solve with the narrow kernel can reach a lower E from the
// given poses. So this solve is tried too, and the solution with the lower E is kept.
#pragma once

#include <cstddef>
#include <vector>

#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

/// Largest residual of a constraint that agrees with the others, in standard deviations. One in 65,000 true
/// constraints exceeds it: it is the square root of that quantile of the chi-square distribution with 3
/// degrees of freedom.
inline constexpr double kInlierChi = 5;

struct GraduatedOptions {
  double inlier_width = kInlierChi;  ///< width of the final kernel, standard deviations
  double narrowing = 1.2;            ///< factor, > 1, by which the squared width falls per round
  int max_rounds = 200;
  int first_iterations = 10;  ///< iterations of the solve with the widest kernel
  int iterations_per_round = 2;
};

struct GraduatedReport {
  /// Solution at the inlier width, with the iterations of the last solve and the total time of all solves.
  PoseAdjustmentReport solution;
  int rounds = 0;  ///< solves between the widest kernel and the inlier width
  /// Enabled loops without a kernel of their own whose residual exceeds the inlier width, ascending.
  std::vector<std::size_t> outliers;
};

/// Moves the poses of the graph and leaves its constraints unchanged. During the call, the
/// Geman-McClure kernel replaces the solver's kernel for loops; constraints with their own kernel keep it.
/// Throws UserError as SparsePoseAdjustment::optimize() does.
GraduatedReport optimize_graduated(PoseGraph& graph, SparsePoseAdjustment& solver,
                                   const GraduatedOptions& options = {});

}  // namespace psi_slam
