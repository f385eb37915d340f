// SPDX-License-Identifier: BSD-3-Clause
// A bound on the uncertainty between one node and all others that costs one walk over the graph, no
// factorisation: the covariance of the relative pose accumulated along one short chain of constraints, the
// "Dijkstra projection" of Olson, "Recognizing places using spectrally clustered local matches", RAS 57
// (2009). What other constraints know is left out, so that the bound is too large rather than too small.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "psi_slam/pose_graph/pose_graph.h"

namespace psi_slam {

struct PathCovarianceOptions {
  /// A chain's cost is the trace of its position covariance plus the square of this length times its heading
  /// variance: heading errors at a node become position errors further on.
  double heading_lever_m = 2;
  /// Nodes that cost more than the square of this are not reached.
  double max_sigma_m = std::numeric_limits<double>::infinity();
  /// If not empty, the search ends when all of these are reached.
  std::vector<std::size_t> targets;
};

/// The pose of one node in the axes of the source.
struct RelativeUncertainty {
  bool reached = false;
  std::size_t previous = 0;    ///< node before this one on the chain from the source; the source's is itself
  std::size_t constraint = 0;  ///< from the previous node to this one, in either direction; not of the source
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta): m^2, m rad, rad^2

  /// The largest standard deviation of the position over all directions.
  double position_sigma_m() const;
};

/// One entry a node. Chains use the enabled constraints, and the current poses for the lever arms. They grow
/// from the cheapest end first, as in Dijkstra's algorithm, ties by the lower node: greedy, because the cost
/// of a chain may fall again on its way back towards the source. Throws std::out_of_range when a node does
/// not exist.
std::vector<RelativeUncertainty> path_covariances(const PoseGraph& graph, std::size_t source,
                                                  const PathCovarianceOptions& options = {});

}  // namespace psi_slam
