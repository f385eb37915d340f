// SPDX-License-Identifier: BSD-3-Clause
// Covariance of the newest node of a graph that grows, at a bounded cost.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Returns the covariance of the pose at the end of a motion that is known exactly, from that of the pose at
/// its beginning. Both poses are in the map.
Eigen::Matrix3d carried_covariance(const Eigen::Matrix3d& covariance, const mrpt::math::TPose2D& begin,
                                   const mrpt::math::TPose2D& end);

/// Covariance of the newest node as pose_covariance() defines it, for callers that ask after each node.
/// Computes it again only after the graph has grown by a share: 0.5 % if it gained loops, otherwise 2 %. So
/// the cost of asking after each node is proportional to the size of the graph. In between, the last
/// covariance is carried along by the motion, and the drift of the path is added.
class NewestCovariance {
 public:
  /// Returns the covariance of (x, y, theta) of the newest node relative to the root, in the axes of the map:
  /// m^2, m rad, rad^2. Zero for fewer than two nodes. `graph` must be the graph of the last call, which may
  /// have gained nodes and constraints. Throws UserError like pose_covariance().
  const Eigen::Matrix3d& update(const PoseGraph& graph);

  /// Returns the mean drift of a node of the newest whole path segment, in the axes of the map, for the graph
  /// of the last update(); in the first segment of a run, that of the nodes so far. Zero if the newest node
  /// begins a run.
  Eigen::Matrix3d newest_drift(const PoseGraph& graph) const;

  /// Number of times that the covariance was computed from the whole graph.
  std::size_t computations() const { return computations_; }

 private:
  bool is_due(std::size_t nodes) const;
  bool carry_to_newest(const PoseGraph& graph);
  void compute(const PoseGraph& graph);

  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  std::size_t first_ = 0;  // node from which the path constraint of the newest node begins
  Eigen::Matrix3d first_covariance_ = Eigen::Matrix3d::Zero();
  std::size_t nodes_ = 0;           // of the graph at the last call
  std::size_t constraints_ = 0;     // of the graph at the last call
  std::size_t computed_nodes_ = 0;  // of the graph at the last computation
  bool gained_loops_ = false;       // since the last computation
  std::size_t computations_ = 0;
};

}  // namespace psi_slam
