// SPDX-License-Identifier: BSD-3-Clause
// Runs of a log whose place in the map is unknown: the robot was moved by hand, and no odometry connects the
// run with the map. Until loops join the run to the map, its nodes are kept beside the map.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>

#include "loop_closure/keyframe_store.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Returns a provisional pose for the first node of an unplaced run, 50 m beside all nodes.
mrpt::math::TPose2D provisional_start(const PoseGraph& graph);

/// Moves the newest unplaced run rigidly to its place, if one of the constraints from number
/// `first_constraint` on is a loop that joins it to the map. Returns whether the run was moved. It then no
/// longer counts as unplaced.
bool place_newest_run(std::size_t first_constraint, KeyframeStore& keyframes, PoseGraph& graph);

/// Moves each run that is still unplaced beside the map, so that the scans of both do not overlap.
void lay_unplaced_runs_aside(const KeyframeStore& keyframes, PoseGraph& graph);

}  // namespace psi_slam
