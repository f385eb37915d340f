// SPDX-License-Identifier: BSD-3-Clause
// Converts a pose graph to MRPT's container and back. A separate header, because that of the container takes
// seconds to compile.
#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Converts all nodes, with their numbers as node ids, and the enabled constraints.
mrpt::graphs::CNetworkOfPoses2DInf mrpt_network(const PoseGraph& graph);

/// Converts a network with the node ids 0 .. N-1. Edges between successive nodes become odometry, other edges
/// loops. Throws UserError that names the first missing node.
PoseGraph pose_graph_of(const mrpt::graphs::CNetworkOfPoses2DInf& network);

}  // namespace psi_slam
