// SPDX-License-Identifier: BSD-3-Clause
// Selects the finished local maps that a node may see again, and the search window for each. The window
// covers the uncertainty of the node relative to the nearest part of the local map, along the best path
// between them in the pose graph. Source: Olson 2009, "Recognizing places using spectrally clustered local
// matches".
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "base/degrees.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "psi_slam/matching.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopCandidateOptions {
  SearchExtent max_window = {8.0, 8.0, radians_from_degrees(30.0L)};  ///< largest half-widths: W of the paper
  double min_window_m = 0.25;
  double min_window_rad = radians_from_degrees(3.5L);
  double window_sigmas = 4.0;  ///< half-width of the window in standard deviations of the prediction
  double reach_m = 5.0;        ///< largest distance between the window and a node of the local map
  /// Smallest length of the robot's path between the node and the local map. The front end already links the
  /// node to local maps nearer along the path.
  double min_travel_m = 10.0;
};

struct LoopCandidate {
  std::size_t local_map = 0;          ///< index in KeyframeStore::local_maps
  mrpt::math::TPose2D anchor_T_node;  ///< centre of the window: predicted pose, or middle of the local map
  SearchExtent extent;
  mrpt::math::TPose2D anchor_T_predicted;  ///< pose of the node by the path; unused if sigma_m is infinite
  double distance_m = 0;  ///< distance from the predicted position to the nearest node of the local map
  /// Standard deviation of the predicted position. Infinite if the path does not know the node's place, or if
  /// a person or the final search chose the window.
  double sigma_m = std::numeric_limits<double>::infinity();
};

/// Returns the weight that the path gives to a match this far from the predicted position:
/// exp(-(d / 2.5)^2 / 2), where d is the distance in standard deviations of the doubtful path.
double path_prior(double moved_m, double sigma_m);

/// Standard deviations of a node's pose relative to another node. Infinite if no path of the graph connects
/// the two.
struct PositionSigma {
  double metres = 0;
  double radians = 0;
};

/// Function that returns the uncertainty of the candidate's node relative to each of the given nodes.
using SigmasOfNodes = std::function<std::vector<PositionSigma>(const std::vector<std::size_t>& nodes)>;

/// Returns the candidates of a node in ascending order of local maps. Calls `sigmas_of_nodes` at most once:
/// for the nearest path segment of each local map within reach of the largest window.
std::vector<LoopCandidate> loop_candidates(std::size_t node, const KeyframeStore& keyframes,
                                           const PoseGraph& graph, const LoopCandidateOptions& options,
                                           const SigmasOfNodes& sigmas_of_nodes);

/// Returns the local maps whose position is so uncertain that the largest search window may miss the robot:
/// `window_sigmas` standard deviations exceed the window, but may bring the local map within reach. The
/// window of such a candidate covers the whole local map, because the robot may be near any of its nodes.
/// Calls `sigmas_of_nodes` at most once.
std::vector<LoopCandidate> far_candidates(std::size_t node, const KeyframeStore& keyframes,
                                          const PoseGraph& graph, const LoopCandidateOptions& options,
                                          const SigmasOfNodes& sigmas_of_nodes);

/// Returns all local maps whose place is known, as candidates of a node whose place is unknown. The window
/// covers the whole local map and all headings.
std::vector<LoopCandidate> whole_map_candidates(std::size_t node, const KeyframeStore& keyframes,
                                                const PoseGraph& graph, const LoopCandidateOptions& options);

}  // namespace psi_slam
