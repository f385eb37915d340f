// SPDX-License-Identifier: BSD-3-Clause
// A new node's constraints to the local maps that its scan was inserted into.
#pragma once

#include "local_maps/front_end.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// The noise of a node's pose in a local map, on top of the front end's covariance.
struct LocalMapNoise {
  double sigma_m = 0;
  double sigma_rad = 0;
};

/// From the anchor of each of its local maps to the step's node. The graph has all these nodes.
void constrain_to_local_maps(const FrontEndStep& step, const LocalMapNoise& noise, PoseGraph& graph);

}  // namespace psi_slam
