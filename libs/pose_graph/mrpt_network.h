// SPDX-License-Identifier: BSD-3-Clause
// A pose graph as MRPT's container, and back. Apart from pose_graph.h, since that container's header takes
// seconds to compile.
#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// All nodes, with their numbers as node ids, and the enabled constraints.
mrpt::graphs::CNetworkOfPoses2DInf mrpt_network(const PoseGraph& graph);

/// Of a network whose node ids are 0 .. N-1 (else throws UserError naming the first that is missing). MRPT's
/// edges have no kind: those between successive numbers become odometry, the others loops.
PoseGraph pose_graph_of(const mrpt::graphs::CNetworkOfPoses2DInf& network);

}  // namespace psi_slam
