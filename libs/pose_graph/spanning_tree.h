// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "psi_slam/pose_graph.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// Returns the pose of every node by chaining measurements from the root's pose, along a path with as few
/// constraints other than odometry as possible. This is dead reckoning where odometry exists, and an initial
/// estimate for files without poses. Throws unreachable_node(), a UserError, if a node is not linked to the
/// root.
std::vector<mrpt::math::TPose2D> spanning_tree_poses(const PoseGraph& graph);

/// Returns the error for a node that no chain of enabled constraints links to the root.
UserError unreachable_node(std::size_t node, std::size_t root);

}  // namespace psi_slam
