// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/placed_covariances.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "pose_graph/shared_errors.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

bool is_provisional(const Constraint& constraint) {
  constexpr double kRounding = 1 + 1e-6;
  return constraint.kind == Constraint::Kind::kRunStart &&
         constraint.information(0, 0) * kProvisionalSigma_m * kProvisionalSigma_m <= kRounding;
}

// Returns the numbers of the nodes that are linked to the root, in ascending order.
std::vector<std::size_t> placed_nodes(const PoseGraph& graph) {
  std::vector<bool> reached(graph.num_nodes(), false);
  std::vector<std::size_t> placed;
  const auto reach = [&](std::size_t node) {
    if (!reached[node]) placed.push_back(node);
    reached[node] = true;
  };
  if (graph.num_nodes() > 0) reach(graph.root());
  for (std::size_t next = 0; next < placed.size(); ++next) {
    const std::size_t node = placed[next];
    for (const std::uint32_t i : graph.constraints_of(node)) {
      const Constraint& constraint = graph.constraint(i);
      if (!graph.enabled(i) || is_provisional(constraint)) continue;
      reach(constraint.from);
      reach(constraint.to);
    }
  }
  std::sort(placed.begin(), placed.end());
  return placed;
}

// Returns the graph of the given nodes, which keep their order, and the enabled constraints between them.
PoseGraph part_of(const PoseGraph& graph, const std::vector<std::size_t>& nodes) {
  PoseGraph part;
  std::vector<std::optional<std::size_t>> number(graph.num_nodes());
  for (const std::size_t node : nodes) number[node] = part.add_node(graph.pose(node));
  part.set_root(*number[graph.root()]);
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    Constraint constraint = graph.constraint(i);
    if (!graph.enabled(i) || !number[constraint.from] || !number[constraint.to]) continue;
    constraint.from = *number[constraint.from];
    constraint.to = *number[constraint.to];
    part.add_constraint(constraint);
  }
  return part;
}

}  // namespace

PlacedPart placed_part(const PoseGraph& graph) {
  std::vector<std::size_t> nodes = placed_nodes(graph);
  PoseGraph part = nodes.empty() ? PoseGraph() : part_of(graph, nodes);
  return {std::move(nodes), std::move(part)};
}

std::vector<std::optional<Eigen::Matrix3d>> placed_covariances(const PoseGraph& graph) {
  std::vector<std::optional<Eigen::Matrix3d>> covariances(graph.num_nodes());
  const PlacedPart placed = placed_part(graph);
  try {
    const std::vector<Eigen::Matrix3d> of_placed = pose_covariances(placed.graph);
    for (std::size_t i = 0; i < placed.nodes.size(); ++i) covariances[placed.nodes[i]] = of_placed[i];
  } catch (const UserError&) {  // a constraint is singular
  }
  return covariances;
}

}  // namespace psi_slam
