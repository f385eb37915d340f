// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/graph_mirror.h"

#include <algorithm>
#include <string>

#include "logs/frames/pose_operations.h"
#include "pose_graph/information_matrix.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::graphs::TNodeID;
using mrpt::math::TPose2D;

Constraint constraint_of(const mrpt::graphs::TPairNodeIDs& ends, const MrptGraph::edge_t& edge) {
  Constraint constraint;
  constraint.from = ends.first;
  constraint.to = ends.second;
  constraint.from_T_to = edge.getPoseMean().asTPose();
  const Eigen::Matrix3d information = edge.cov_inv.asEigen();
  constraint.information = (information + information.transpose()) / 2;
  if (!is_information_matrix(constraint.information)) constraint.information.setIdentity();
  const bool successive = ends.first + 1 == ends.second || ends.second + 1 == ends.first;
  constraint.kind = successive ? Constraint::Kind::kOdometry : Constraint::Kind::kLoop;
  return constraint;
}

}  // namespace

void GraphMirror::publish(MrptGraph& network) {
  for (; shared_nodes_ < graph_.num_nodes(); ++shared_nodes_)
    network.nodes[shared_nodes_] = mrpt::poses::CPose2D(graph_.pose(shared_nodes_));
  for (; shared_constraints_ < graph_.num_constraints(); ++shared_constraints_) {
    const Constraint& constraint = graph_.constraint(shared_constraints_);
    const mrpt::math::CMatrixDouble33 information(constraint.information);
    network.insertEdgeAtEnd(constraint.from, constraint.to,
                            {mrpt::poses::CPose2D(constraint.from_T_to), information});
    edges_[{constraint.from, constraint.to}].push_back(shared_constraints_);
  }
}

void GraphMirror::read(const MrptGraph& network) {
  if (network.nodes.size() > shared_nodes_) add_nodes_of(network);
  if (network.edges.size() == shared_constraints_) return;
  // A multimap keeps the edges between two nodes in the order of insertion.
  for (auto edge = network.edges.begin(); edge != network.edges.end();) {
    const Ends ends = edge->first;
    const auto known = edges_.find(ends);
    std::size_t seen = known == edges_.end() ? 0 : known->second.size();
    for (; edge != network.edges.end() && edge->first == ends; ++edge) {
      if (seen > 0) {
        --seen;
      } else {
        edges_[ends].push_back(graph_.add_constraint(constraint_of(ends, edge->second)));
        ++shared_constraints_;
      }
    }
  }
}

void GraphMirror::add_nodes_of(const MrptGraph& network) {
  for (TNodeID id = shared_nodes_; id < network.nodes.size(); ++id) {
    const auto node = network.nodes.find(id);
    if (node == network.nodes.end())
      throw UserError("the pose graph has no node " + std::to_string(id) + ": its " +
                      std::to_string(network.nodes.size()) +
                      " nodes must be numbered from 0 without a gap. Choose another node decider");
    // MRPT's deciders may register the root with another pose, but the engine keeps it at the origin.
    TPose2D pose = id == network.root ? TPose2D(0, 0, 0) : node->second.asTPose();
    for (const auto& [ends, edge] : network.edges) {
      const bool leads_here = ends.second == id && ends.first < graph_.num_nodes();
      if (!leads_here) continue;
      pose = compose(graph_.pose(ends.first), edge.getPoseMean().asTPose());
      break;
    }
    graph_.add_node(pose);
  }
  shared_nodes_ = network.nodes.size();
}

void GraphMirror::read_poses(const MrptGraph& network) {
  for (std::size_t node = 0; node < shared_nodes_; ++node)
    graph_.set_pose(node, network.nodes.at(node).asTPose());
}

void GraphMirror::write_poses(MrptGraph& network) const {
  for (std::size_t node = 0; node < shared_nodes_; ++node)
    static_cast<mrpt::poses::CPose2D&>(network.nodes.at(node)) = mrpt::poses::CPose2D(graph_.pose(node));
}

void GraphMirror::remove_disabled(MrptGraph& network) {
  for (auto& [ends, constraints] : edges_) {
    auto edge = network.edges.lower_bound(ends);
    const auto is_off = [&](std::size_t constraint) { return !graph_.enabled(constraint); };
    for (const std::size_t constraint : constraints)
      edge = is_off(constraint) ? network.edges.erase(edge) : std::next(edge);
    constraints.erase(std::remove_if(constraints.begin(), constraints.end(), is_off), constraints.end());
  }
}

}  // namespace psi_slam
