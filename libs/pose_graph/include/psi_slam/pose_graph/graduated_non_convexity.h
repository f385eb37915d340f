// SPDX-License-Identifier: BSD-3-Clause
// Optimisation of a graph in which a part of the loop constraints may be false, without a good first guess of
// which: graduated non-convexity (Yang, Antonante, Tzoumas, Carlone, "Graduated non-convexity for robust
// spatial perception", RA-L 2020) with the Geman-McClure kernel. It begins with a kernel so wide that E is
// nearly the convex one, and narrows it solve by solve, so that constraints against which the others agree
// lose their say one after another.
#pragma once

#include <cstddef>
#include <vector>

#include "psi_slam/pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct GraduatedOptions {
  double inlier_width = 3.37;  ///< in standard deviations: the root of the 99 % quantile of chi-square, 3 dof
  double narrowing = 1.4;      ///< > 1: the width's square falls by this a round
  int max_rounds = 100;
  int iterations_per_round = 3;
};

struct GraduatedReport {
  PoseAdjustmentReport
      solution;    ///< of the last solve, at the inlier width; its initial values are the caller's
  int rounds = 0;  ///< solves before the last
  std::vector<std::size_t>
      outliers;  ///< enabled constraints of the kind kLoop beyond the inlier width, ascending
};

/// Moves the graph's poses; the constraints stay as they are, enabled or not. The kernel replaces the
/// solver's for loops while this runs; constraints with a kernel of their own keep it. Throws as
/// SparsePoseAdjustment::optimize.
GraduatedReport optimize_graduated(PoseGraph& graph, SparsePoseAdjustment& solver,
                                   const GraduatedOptions& options = {});

}  // namespace psi_slam
