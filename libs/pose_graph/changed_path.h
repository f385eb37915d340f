// SPDX-License-Identifier: BSD-3-Clause
// Copies of a pose graph whose front end measured something else.
#pragma once

#include <cstddef>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Returns a copy of the graph in which `change` has changed each constraint of the front end, which form its
/// path.
template <class Change>
PoseGraph with_changed_path(const PoseGraph& graph, const Change& change) {
  PoseGraph changed;
  for (const mrpt::math::TPose2D& pose : graph.poses()) changed.add_node(pose);
  changed.set_root(graph.root());
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    Constraint constraint = graph.constraint(i);
    if (constraint.kind == Constraint::Kind::kOdometry || constraint.kind == Constraint::Kind::kLocalMap)
      change(constraint);
    changed.set_enabled(changed.add_constraint(constraint), graph.enabled(i));
  }
  return changed;
}

}  // namespace psi_slam
