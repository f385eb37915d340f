// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/mrpt_network.h"

#include <string>

#include "psi_slam/user_error.h"

namespace psi_slam {

mrpt::graphs::CNetworkOfPoses2DInf mrpt_network(const PoseGraph& graph) {
  mrpt::graphs::CNetworkOfPoses2DInf network;
  network.root = graph.root();
  for (std::size_t i = 0; i < graph.num_nodes(); ++i) network.nodes[i] = mrpt::poses::CPose2D(graph.pose(i));
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    if (!graph.enabled(i)) continue;
    const Constraint& constraint = graph.constraint(i);
    const mrpt::math::CMatrixDouble33 information(constraint.information);
    network.insertEdgeAtEnd(constraint.from, constraint.to,
                            {mrpt::poses::CPose2D(constraint.from_T_to), information});
  }
  return network;
}

PoseGraph pose_graph_of(const mrpt::graphs::CNetworkOfPoses2DInf& network) {
  PoseGraph graph;
  for (std::size_t i = 0; i < network.nodes.size(); ++i) {
    const auto node = network.nodes.find(i);
    if (node == network.nodes.end()) {
      throw UserError("the pose graph has no node " + std::to_string(i) + ": its " +
                      std::to_string(network.nodes.size()) + " nodes must be numbered from 0 without a gap");
    }
    graph.add_node(node->second.asTPose());
  }
  for (const auto& [ends, edge] : network.edges) {
    Constraint constraint;
    constraint.from = ends.first;
    constraint.to = ends.second;
    constraint.from_T_to = edge.getPoseMean().asTPose();
    constraint.information = edge.cov_inv.asEigen();
    const bool successive = ends.first + 1 == ends.second || ends.second + 1 == ends.first;
    constraint.kind = successive ? Constraint::Kind::kOdometry : Constraint::Kind::kLoop;
    graph.add_constraint(constraint);
  }
  if (graph.num_nodes() > 0) graph.set_root(network.root);
  return graph;
}

}  // namespace psi_slam
