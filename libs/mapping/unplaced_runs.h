// SPDX-License-Identifier: BSD-3-Clause
// Runs of a log whose place in the map is unknown: the robot was moved by hand, and no odometry connects the
// run with the map. Until loops join the run to the map, its nodes are kept beside the map. Only nodes of the
// run itself search for its place. A run that ended unplaced is joined only by loops made by hand.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "mapping/loop_closure/keyframe_store.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Returns a provisional pose for the first node of an unplaced run, 50 m beside all nodes.
mrpt::math::TPose2D provisional_start(const PoseGraph& graph);

/// Moves one unplaced run rigidly to its place, if one of the constraints from number `first_constraint` on
/// is a loop that joins it to the map. Returns this run, which no longer counts as unplaced; nothing if no
/// run was moved.
std::optional<UnplacedRun> place_joined_run(std::size_t first_constraint, KeyframeStore& keyframes,
                                            PoseGraph& graph);

/// Returns those of `runs` that no chain of enabled loops joins to the nodes outside all `runs`.
std::vector<UnplacedRun> unjoined_runs(const std::vector<UnplacedRun>& runs, const PoseGraph& graph);

/// Moves each of `runs` beside the map, so that the scans of both do not overlap.
void lay_aside(const std::vector<UnplacedRun>& runs, const KeyframeStore& keyframes, PoseGraph& graph);

}  // namespace psi_slam
