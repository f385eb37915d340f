// SPDX-License-Identifier: BSD-3-Clause
// Which finished local maps a node may see again, and how large a window each needs: the pose graph's own
// uncertainty of the node seen from the local map, projected along the best path between them (Olson 2009,
// "Recognizing places using spectrally clustered local matches").
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "base/degrees.h"
#include "loop_closure/keyframe_store.h"
#include "matching/search_window.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopCandidateOptions {
  SearchExtent max_window = {8.0, 8.0, radians_from_degrees(30.0L)};  ///< the paper's W: 8 m, 30 degrees
  double min_window_m = 0.25;
  double min_window_rad = radians_from_degrees(3.5L);
  double window_sigmas = 3.0;  ///< the window covers this many standard deviations of the prediction
  double reach_m = 5.0;  ///< a local map is near when one of its nodes is at most this far from the window
  double min_travel_m =
      10.0;  ///< between the node and the local map's last node: nearer ones share their scans
};

struct LoopCandidate {
  std::size_t local_map = 0;          ///< index in KeyframeStore::local_maps
  mrpt::math::TPose2D anchor_T_node;  ///< predicted from the graph
  SearchExtent extent;
  double distance_m = 0;  ///< from the predicted position to the nearest node of the local map
};

/// The local maps that may be candidates however uncertain the node is, ascending: near in the graph, though
/// not along the path. What is not among them is not worth a look at the uncertainty.
std::vector<std::size_t> local_maps_in_reach(std::size_t node, const KeyframeStore& memory,
                                             const PoseGraph& graph, const LoopCandidateOptions& options);

/// How far the pose of a node seen from another one can be trusted.
struct PositionSigma {
  double metres = 0;
  double radians = 0;
};

/// The candidates of a node, in the order of the local maps' ids. `sigma_of_anchor[m]` is the node's
/// uncertainty seen from the anchor of local map m.
std::vector<LoopCandidate> loop_candidates(std::size_t node, const KeyframeStore& memory,
                                           const PoseGraph& graph,
                                           const std::vector<PositionSigma>& sigma_of_anchor,
                                           const LoopCandidateOptions& options);

}  // namespace psi_slam
