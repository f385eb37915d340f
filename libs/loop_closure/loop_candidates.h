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
  /// Drift of the position for each metre of the shortest chain of constraints to a local map. Local maps
  /// that this drift may have moved out of the largest window are searched as a whole.
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

/// Returns the lengths in metres of chains of constraints from the node to the anchors of these local maps,
/// in their order. Infinite where there is no chain.
using ChainsToAnchors = std::function<std::vector<double>(const std::vector<std::size_t>& local_maps)>;

/// Local maps that drift may have moved out of the reach of loop_candidates(): the drift over the chain of
/// constraints to the local map exceeds the largest window and reaches the node. Their windows are the whole
/// local maps, because the robot may be at any of the nodes. Calls `chains_to_anchors` at most once, and only
/// for local maps that the robot's whole path since then may have moved as far.
std::vector<LoopCandidate> far_candidates(std::size_t node, const KeyframeStore& keyframes,
                                          const PoseGraph& graph, const LoopCandidateOptions& options,
                                          const ChainsToAnchors& chains_to_anchors);

}  // namespace psi_slam
