// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// The pose of every node by chaining measurements from the root's pose, along a path with as few constraints
/// other than odometry as possible: dead reckoning where there is odometry, and a first guess for files
/// without poses. Throws UserError when no chain of enabled constraints leads from the root to some node.
std::vector<mrpt::math::TPose2D> spanning_tree_poses(const PoseGraph& graph);

}  // namespace psi_slam
