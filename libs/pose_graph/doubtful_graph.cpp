// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/doubtful_graph.h"

#include <Eigen/LU>

#include "pose_graph/information_matrix.h"

namespace psi_slam {

PoseGraph doubtful_graph(const PoseGraph& graph) {
  PoseGraph doubtful;
  for (const mrpt::math::TPose2D& pose : graph.poses()) doubtful.add_node(pose);
  if (graph.num_nodes() > 0) doubtful.set_root(graph.root());
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    Constraint constraint = graph.constraint(i);
    if (!constraint.doubt.isZero(0))
      constraint.information = noisy_information(constraint.information.inverse() + constraint.doubt, 0, 0);
    doubtful.set_enabled(doubtful.add_constraint(constraint), graph.enabled(i));
  }
  return doubtful;
}

}  // namespace psi_slam
