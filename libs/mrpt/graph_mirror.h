// SPDX-License-Identifier: BSD-3-Clause
// One pose graph in two forms. MRPT's graph-slam engine and all deciders share MRPT's form, a network. The
// solver and the path search read psi-slam's PoseGraph. publish() copies new nodes and constraints to MRPT's
// network, and read() copies new ones from the network. Only read_poses() and write_poses() copy the poses of
// known nodes.
//
// After every new node, MRPT's engine recomputes all poses along the shortest paths from the root
// (CNetworkOfPoses::dijkstra_nodes_estimate). This discards the poses of an optimizer. An optimizer therefore
// keeps its poses in a GraphMirror and writes them back.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "mapping/loop_closure/keyframe_store.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/graphslam_deciders.h"

namespace psi_slam {

class GraphMirror {
 public:
  /// psi-slam's graph. publish() copies its new nodes and constraints to MRPT's network.
  PoseGraph& graph() { return graph_; }
  const PoseGraph& graph() const { return graph_; }

  /// Adds new nodes and constraints of graph() to `network`.
  void publish(MrptGraph& network);

  /// Adds the nodes and edges that other deciders put into `network`; call publish() first. The pose of a new
  /// node follows from the first edge that leads to it. An edge with invalid information gets standard
  /// deviations of 1 m and 1 rad. Throws UserError if nodes are not numbered from 0 without a gap.
  void read(const MrptGraph& network);

  void read_poses(const MrptGraph& network);
  void write_poses(MrptGraph& network) const;

  /// Removes the edges of disabled constraints from `network` permanently.
  void remove_disabled(MrptGraph& network);

 private:
  using Ends = mrpt::graphs::TPairNodeIDs;
  void add_nodes_of(const MrptGraph& network);

  PoseGraph graph_;
  std::size_t shared_nodes_ = 0;        ///< nodes 0 to shared_nodes_ - 1 are in both graphs
  std::size_t shared_constraints_ = 0;  ///< number of constraints in both graphs
  /// Constraints between each pair of nodes, in MRPT's order.
  std::map<Ends, std::vector<std::size_t>> edges_;
};

/// The data that psi-slam's deciders and optimizer share. MRPT's interfaces let them share only the graph.
struct SharedMap {
  GraphMirror mirror;
  KeyframeStore keyframes;                     ///< filled by the node decider
  std::vector<double> odometry_m;              ///< path length by odometry up to each node, in metres
  std::optional<SparsePoseAdjustment> solver;  ///< set by CPsiSpaGSO; then `mirror` holds the current poses
};

}  // namespace psi_slam
