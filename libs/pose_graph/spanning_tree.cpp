// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/spanning_tree.h"

#include <cstdint>
#include <deque>
#include <string>

#include "logs/frames/pose_operations.h"

namespace psi_slam {

std::vector<mrpt::math::TPose2D> spanning_tree_poses(const PoseGraph& graph) {
  using mrpt::math::TPose2D;
  std::vector<TPose2D> poses(graph.num_nodes());
  if (poses.empty()) return poses;
  struct Arrival {
    std::size_t node;
    TPose2D map_T_node;
  };
  std::vector<char> reached(graph.num_nodes(), 0);
  std::deque<Arrival> by_odometry{{graph.root(), graph.pose(graph.root())}};
  std::deque<Arrival> by_others;  // used only when no further node can be reached by odometry
  while (!by_odometry.empty() || !by_others.empty()) {
    std::deque<Arrival>& queue = by_odometry.empty() ? by_others : by_odometry;
    const Arrival arrival = queue.front();
    queue.pop_front();
    if (reached[arrival.node] != 0) continue;
    reached[arrival.node] = 1;
    poses[arrival.node] = arrival.map_T_node;
    for (const std::uint32_t index : graph.constraints_of(arrival.node)) {
      if (!graph.enabled(index)) continue;
      const Constraint& constraint = graph.constraint(index);
      const bool forward = constraint.from == arrival.node;
      const std::size_t next = forward ? constraint.to : constraint.from;
      if (reached[next] != 0) continue;
      const TPose2D node_T_next = forward ? constraint.from_T_to : inverse(constraint.from_T_to);
      (constraint.kind == Constraint::Kind::kOdometry ? by_odometry : by_others)
          .push_back({next, compose(arrival.map_T_node, node_T_next)});
    }
  }
  for (std::size_t node = 0; node < poses.size(); ++node)
    if (reached[node] == 0) throw unreachable_node(node, graph.root());
  return poses;
}

UserError unreachable_node(std::size_t node, std::size_t root) {
  return UserError("node " + std::to_string(node) + " of the pose graph is not linked to node " +
                   std::to_string(root) +
                   ": expected a chain of constraints from every node to that node. Add a constraint, or "
                   "remove the node.");
}

}  // namespace psi_slam
