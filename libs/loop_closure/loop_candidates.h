// SPDX-License-Identifier: BSD-3-Clause
// Which finished local maps a node may see again, and how large a search window each needs: the pose graph's
// uncertainty of the node relative to the local map, along the best path between them (Olson 2009,
// "Recognizing places using spectrally clustered local matches").
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "base/degrees.h"
#include "loop_closure/keyframe_store.h"
#include "psi_slam/matching.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopCandidateOptions {
  SearchExtent max_window = {8.0, 8.0, radians_from_degrees(30.0L)};  ///< the paper's W
  double min_window_m = 0.25;
  double min_window_rad = radians_from_degrees(3.5L);
  double window_sigmas = 3.0;  ///< half-width of the window in standard deviations of the prediction
  double reach_m = 5.0;        ///< largest distance between the window and a node of the local map
  /// Shortest path between the node and the local map's nearest node. Nearer local maps share scans with it.
  double min_travel_m = 10.0;
  /// Drift of the position per metre of path without a loop that the largest window may not hold: local maps
  /// within this drift are searched as a whole, whatever the graph's uncertainty says.
  double drift_per_metre = 0.02;
};

struct LoopCandidate {
  std::size_t local_map = 0;          ///< index in KeyframeStore::local_maps
  mrpt::math::TPose2D anchor_T_node;  ///< predicted by the graph
  SearchExtent extent;
  double distance_m = 0;  ///< from the predicted position to the nearest node of the local map
};

/// Standard deviations of a node's pose relative to another node. Infinite where nothing is known.
struct PositionSigma {
  double metres = 0;
  double radians = 0;
};

/// Returns the node's uncertainty relative to the anchor of each of these local maps, in their order.
using SigmasOfAnchors = std::function<std::vector<PositionSigma>(const std::vector<std::size_t>& local_maps)>;

/// The candidates of a node by ascending local map. Calls `sigmas_of_anchors` at most once, and only for
/// local maps within reach of the largest window.
std::vector<LoopCandidate> loop_candidates(std::size_t node, const KeyframeStore& keyframes,
                                           const PoseGraph& graph, const LoopCandidateOptions& options,
                                           const SigmasOfAnchors& sigmas_of_anchors);

/// Local maps that drift may have moved out of the reach of loop_candidates(): those within
/// `options.drift_per_metre` x `since_loop_m`, the path of the robot since its last loop. The window is the
/// whole local map: the robot may be within reach of any of its nodes.
std::vector<LoopCandidate> far_candidates(std::size_t node, const KeyframeStore& keyframes,
                                          const PoseGraph& graph, double since_loop_m,
                                          const LoopCandidateOptions& options);

}  // namespace psi_slam
