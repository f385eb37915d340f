// SPDX-License-Identifier: BSD-3-Clause
// Covariances of the nodes whose place in the map is known.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Standard deviation of the position of a provisional start, metres. A constraint of the kind kRunStart with
/// at least this deviation only keeps the graph connected: it does not place its run in the map.
constexpr double kProvisionalSigma_m = 1e3;
/// Standard deviation of the heading of a provisional start, radians.
constexpr double kProvisionalSigma_rad = 30;

/// The part of a graph whose place in the map is known.
struct PlacedPart {
  std::vector<std::size_t> nodes;  ///< numbers of the nodes in the whole graph, ascending
  PoseGraph graph;  ///< of these nodes in this order, with the enabled constraints between them
};

/// Returns the nodes that enabled constraints, except provisional starts, link to the root.
PlacedPart placed_part(const PoseGraph& graph);

/// Returns pose_covariances() of the nodes that enabled constraints, except provisional starts, link to the
/// root. Empty for the other nodes, and for all nodes if the constraints do not determine the poses.
std::vector<std::optional<Eigen::Matrix3d>> placed_covariances(const PoseGraph& graph);

}  // namespace psi_slam
