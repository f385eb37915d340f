// SPDX-License-Identifier: BSD-3-Clause
// Our deciders among each other and with MRPT's: to be called around the life of MRPT's graph-slam engine.
//
//     connect_deciders(node_decider, edge_decider, optimizer);
//     mrpt::graphslam::CGraphSlamEngine<MrptGraph> engine(ini, rawlog, "", nullptr, &node_decider, ...);
//     engine._execGraphSlamStep(...);  // for each entry
//     finish_deciders(node_decider, edge_decider, optimizer);
#pragma once

#include <mrpt/graphslam/interfaces/CEdgeRegistrationDecider.h>
#include <mrpt/graphslam/interfaces/CGraphSlamOptimizer.h>
#include <mrpt/graphslam/interfaces/CNodeRegistrationDecider.h>

#include <functional>

#include "mrpt/graph_mirror.h"

namespace psi_slam {

using NodeDecider = mrpt::graphslam::deciders::CNodeRegistrationDecider<MrptGraph>;
using EdgeDecider = mrpt::graphslam::deciders::CEdgeRegistrationDecider<MrptGraph>;
using GraphOptimizer = mrpt::graphslam::optimizers::CGraphSlamOptimizer<MrptGraph>;

/// Lets those of the three that are ours work on the same map; those that are MRPT's are left alone. Throws
/// UserError when the edge decider is ours and the node decider is not.
void connect_deciders(NodeDecider& node_decider, EdgeDecider& edge_decider, GraphOptimizer& optimizer);

/// After the last entry, with the engine at rest: what each of ours does at the end of a log. `progress` as
/// CPsiLoopCloserERD::finish().
void finish_deciders(NodeDecider& node_decider, EdgeDecider& edge_decider, GraphOptimizer& optimizer,
                     const std::function<bool(double)>& progress = {});

}  // namespace psi_slam
