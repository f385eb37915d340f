// SPDX-License-Identifier: BSD-3-Clause
// Keeps the work and the memory of mapping in proportion to the building, however often the robot drives
// through it: decides which local maps later passes supersede.
//
// With k passes through a place that loops tie to each other, a match with one more of them adds about
// ln(1 + 1/k) / 2 nats to what is known of each coordinate of the robot's pose: 0.35 for the second pass, but
// 0.11 for the fifth. The same passes show a building that changes as it is now. So local maps that were
// passed kLaterPasses times since are not matched, and their scans not kept.
#pragma once

#include <cstddef>
#include <vector>

#include "mapping/loop_closure/keyframe_store.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Number of later passes that supersede a scan.
inline constexpr std::size_t kLaterPasses = 4;

/// Returns the local maps, in ascending order, of which every scan is superseded: at least kLaterPasses later
/// passes of the robot have a node at the same place, which is at most one metre of distance and turn away,
/// see travel_and_turn_m(). A pass is later if the robot travelled at least `min_travel_m` before it
/// returned. Only nodes in local maps that an accepted loop ties to an earlier pass count. Never superseded
/// are local maps of runs whose place is unknown, and those with the root of the graph, which is the frame of
/// the map.
std::vector<std::size_t> superseded_maps(const KeyframeStore& keyframes, const PoseGraph& graph,
                                         double min_travel_m);

/// Frees local maps, and the points of the scans that no other local map holds. Returns the nodes of these
/// scans in ascending order.
std::vector<std::size_t> drop_local_maps(const std::vector<std::size_t>& local_maps,
                                         KeyframeStore& keyframes);

}  // namespace psi_slam
