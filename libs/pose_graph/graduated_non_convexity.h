// SPDX-License-Identifier: BSD-3-Clause
// Optimisation of a graph in which a part of the loop constraints may be false, without knowing which:
// graduated non-convexity (Yang, Antonante, Tzoumas, Carlone, "Graduated non-convexity for robust spatial
// perception", RA-L 2020) with the Geman-McClure kernel. It begins with a kernel so wide that E is nearly the
// plain one, and narrows it solve by solve, so that constraints that the others speak against lose their say
// one after another. Where so many are false that the wide kernels lead astray, the narrow kernel from the
// given poses may end lower; the lower one is taken.
#pragma once

#include <cstddef>
#include <vector>

#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct GraduatedOptions {
  double inlier_width = 3.37;  ///< in standard deviations: the root of the 99 % quantile of chi-square, 3 dof
  double narrowing = 1.2;      ///< > 1: the width's square falls by this factor a round
  int max_rounds = 200;
  int first_iterations = 10;  ///< of the solve with the widest kernel
  int iterations_per_round = 2;
};

struct GraduatedReport {
  PoseAdjustmentReport
      solution;    ///< at the inlier width; its iterations are the last solve's, its time is of all
  int rounds = 0;  ///< kernels between the widest and the inlier width
  std::vector<std::size_t>
      outliers;  ///< enabled constraints of the kind kLoop beyond the inlier width, ascending
};

/// Moves the graph's poses; the constraints stay as they are, enabled or not. The kernel replaces the
/// solver's for loops while this runs; constraints with a kernel of their own keep it. Throws as
/// SparsePoseAdjustment::optimize.
GraduatedReport optimize_graduated(PoseGraph& graph, SparsePoseAdjustment& solver,
                                   const GraduatedOptions& options = {});

}  // namespace psi_slam
