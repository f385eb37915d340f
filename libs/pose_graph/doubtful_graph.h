// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Returns the graph with the covariance of each constraint enlarged by Constraint::doubt. Poses, root, and
/// the numbers and states of the constraints are those of `graph`.
PoseGraph doubtful_graph(const PoseGraph& graph);

}  // namespace psi_slam
