// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/local_map_constraints.h"

#include "pose_graph/information_matrix.h"

namespace psi_slam {

void constrain_to_local_maps(const FrontEndStep& step, const LocalMapNoise& noise, PoseGraph& graph) {
  for (const FrontEndStep::Membership& membership : step.memberships) {
    Constraint constraint;
    constraint.kind = Constraint::Kind::kLocalMap;
    constraint.from = membership.anchor;
    constraint.to = step.node.value();
    constraint.from_T_to = membership.anchor_T_node;
    constraint.information = noisy_information(membership.covariance, noise.sigma_m, noise.sigma_rad);
    graph.add_constraint(constraint);
  }
}

}  // namespace psi_slam
