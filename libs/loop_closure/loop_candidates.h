// SPDX-License-Identifier: BSD-3-Clause
// Selects the finished local maps that a node may see again, and the search window for each. The window
// covers the uncertainty of the node relative to the local map, along the best path between them in the pose
// graph. Source: Olson 2009, "Recognizing places using spectrally clustered local matches".
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
  SearchExtent max_window = {8.0, 8.0, radians_from_degrees(30.0L)};  ///< largest half-widths: W of the paper
  double min_window_m = 0.25;
  double min_window_rad = radians_from_degrees(3.5L);
  double window_sigmas = 3.0;  ///< half-width of the window in standard deviations of the prediction
  double reach_m = 5.0;        ///< largest distance between the window and a node of the local map
  /// Smallest length of the robot's path between the node and the local map. The front end already links the
  /// node to local maps nearer along the path.
  double min_travel_m = 10.0;
  /// Assumed drift of the position per metre of the chain of constraints to a local map. If this drift
  /// exceeds the largest window, far_candidates() searches the local map as a whole.
  double drift_per_metre = 0.02;
};

struct LoopCandidate {
  std::size_t local_map = 0;          ///< index in KeyframeStore::local_maps
  mrpt::math::TPose2D anchor_T_node;  ///< centre of the window: predicted pose, or middle of the local map
  SearchExtent extent;
  double distance_m = 0;  ///< distance from the predicted position to the nearest node of the local map
};

/// Standard deviations of a node's pose relative to another node. Infinite if no path of the graph connects
/// the two.
struct PositionSigma {
  double metres = 0;
  double radians = 0;
};

/// Function that returns the node's uncertainty relative to the anchor of each given local map.
using SigmasOfAnchors = std::function<std::vector<PositionSigma>(const std::vector<std::size_t>& local_maps)>;

/// Returns the candidates of a node in ascending order of local maps. Calls `sigmas_of_anchors` at most once,
/// for the local maps within reach of the largest window.
std::vector<LoopCandidate> loop_candidates(std::size_t node, const KeyframeStore& keyframes,
                                           const PoseGraph& graph, const LoopCandidateOptions& options,
                                           const SigmasOfAnchors& sigmas_of_anchors);

/// Function that returns the length, in metres, of the chain of constraints from the node to the anchor of
/// each given local map. The length is infinite without a chain.
using ChainsToAnchors = std::function<std::vector<double>(const std::vector<std::size_t>& local_maps)>;

/// Returns local maps that drift may have moved out of the reach of loop_candidates(). The assumed drift is
/// `options.drift_per_metre` times the length of the chain of constraints to the local map. The window covers
/// the whole local map, because the robot may be near any of its nodes. Calls `chains_to_anchors` at most
/// once, for local maps from which the robot's whole path is long enough for such a drift.
std::vector<LoopCandidate> far_candidates(std::size_t node, const KeyframeStore& keyframes,
                                          const PoseGraph& graph, const LoopCandidateOptions& options,
                                          const ChainsToAnchors& chains_to_anchors);

/// Returns all local maps whose place is known, as candidates of a node whose place is unknown. The window
/// covers the whole local map and all headings.
std::vector<LoopCandidate> whole_map_candidates(std::size_t node, const KeyframeStore& keyframes,
                                                const PoseGraph& graph, const LoopCandidateOptions& options);

}  // namespace psi_slam
