// SPDX-License-Identifier: BSD-3-Clause
// One pose graph in two forms: MRPT's network, which its graph-slam engine and all deciders share, and ours,
// which the solver and the path search read. What we add goes from ours into MRPT's, what others add the
// other way; poses are copied in whichever direction is asked for.
//
// After every new node MRPT's engine sets all poses anew along the shortest paths from the root, whatever an
// optimizer made of them (CNetworkOfPoses::dijkstra_nodes_estimate). An optimizer whose poses are to last
// must therefore keep them here and write them back.
#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>

#include <cstddef>
#include <map>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

using MrptGraph = mrpt::graphs::CNetworkOfPoses2DInf;

class GraphMirror {
 public:
  /// What is added here reaches MRPT's network with publish().
  PoseGraph& graph() { return graph_; }
  const PoseGraph& graph() const { return graph_; }

  /// Puts our new nodes and constraints into `network`.
  void publish(MrptGraph& network);

  /// Takes the nodes and edges that others have put into `network`; publish() must have come before. A new
  /// node stands where the first edge that leads to it says, seen from our pose of the other end. An edge
  /// whose information is no inverse covariance counts as one of 1 m and 1 rad. Throws UserError when nodes
  /// are not numbered from 0 without a gap.
  void read(const MrptGraph& network);

  void read_poses(const MrptGraph& network);
  void write_poses(MrptGraph& network) const;

  /// Takes the edges of constraints that are switched off out of `network`, for good.
  void remove_disabled(MrptGraph& network);

 private:
  using Ends = mrpt::graphs::TPairNodeIDs;
  void add_nodes_of(const MrptGraph& network);
  void add_edge(const Ends& ends, const MrptGraph::edge_t& edge);

  PoseGraph graph_;
  std::size_t shared_nodes_ = 0;                    ///< that both have; of ours, those that come first
  std::size_t shared_constraints_ = 0;              ///< the same of constraints
  std::map<Ends, std::vector<std::size_t>> edges_;  ///< our constraints of each pair, in MRPT's order
};

}  // namespace psi_slam
