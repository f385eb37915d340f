// SPDX-License-Identifier: BSD-3-Clause
// Decides which local maps later passes of the robot supersede. They are not matched, their scans not kept
// and not drawn. On a tour that the robot drives again and again, the work and the memory for these then do
// not grow with each lap. A local map is freed only as a whole, so other ways through a building free less.
// Poses, constraints and records of loops stay and grow with the path.
//
// Let k passes through a place be tied to each other by loops, each with the same error. One more pass lowers
// the variance of the place from 1/k to 1/(k + 1) of that of one pass. The gain of information is
// ln(1 + 1/k) / 2 for each coordinate: 0.35 nats for the second pass, but 0.11 for the fifth. So four later
// passes supersede a scan. They also show the place as it is now.
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
/// returned. Only nodes in other local maps that an accepted loop ties to an earlier pass count. Never
/// superseded are local maps of runs whose place is unknown, and those with the root of the graph, which is
/// the frame of the map.
std::vector<std::size_t> superseded_maps(const KeyframeStore& keyframes, const PoseGraph& graph,
                                         double min_travel_m);

/// Frees local maps, and the points of the scans that no other local map holds. Returns the nodes of these
/// scans in ascending order.
std::vector<std::size_t> drop_local_maps(const std::vector<std::size_t>& local_maps,
                                         KeyframeStore& keyframes);

}  // namespace psi_slam
