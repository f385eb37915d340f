// SPDX-License-Identifier: BSD-3-Clause
// Covariances of the poses of a graph whose loops share errors.
//
// The path of the graph states its true uncertainty: segments of the path are linked by the drift from one to
// the next, and the scans hang on their segments. But loops between the same two segments repeat one
// measurement: from successive scans, with overlapping local maps, and in both directions. The solver takes
// them for independent, which places the nodes well but makes the covariances too small. The model joins all
// loops between two segments to one constraint.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Share of the variance of a loop that all loops between the same two segments have in common. A little
/// above the correlation of loops of neighbouring scans, which is 0.7, see share/doc/covariances.md.
inline constexpr double kCommonLoopShare = 0.8;

/// Returns the first node of the path segment of each node: the node itself if it is the first.
std::vector<std::size_t> segments_of(const PoseGraph& graph);

/// Returns the graph of the model at the poses of `graph`, for MarginalCovariance. The nodes keep their
/// numbers and the root. The constraints agree exactly with the poses, so optimising the graph of the model
/// moves nothing. Throws UserError if the information of all loops between two segments is singular.
PoseGraph graph_with_shared_errors(const PoseGraph& graph);

/// Returns the covariance of (x, y, theta) of each node relative to the root, in the axes of the map: m^2,
/// m rad, rad^2. Uses the model of shared errors. Zero for the root. Throws UserError like
/// graph_with_shared_errors(), if a node is not linked to the root, or if the constraints do not determine
/// all poses.
std::vector<Eigen::Matrix3d> pose_covariances(const PoseGraph& graph);

/// Returns pose_covariances(graph)[node] in less time.
Eigen::Matrix3d pose_covariance(const PoseGraph& graph, std::size_t node);

}  // namespace psi_slam
