// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "pose_graph/information_matrix.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Adds a constraint that agrees with the poses of both nodes, and returns its number. `sigma` is its
/// standard deviation in metres and in radians.
inline std::size_t add_link(std::size_t from, std::size_t to, Constraint::Kind kind, double sigma,
                            PoseGraph& graph) {
  Constraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.from_T_to = graph.pose(to) - graph.pose(from);
  constraint.information = noisy_information(Eigen::Matrix3d::Zero(), sigma, sigma);
  constraint.kind = kind;
  return graph.add_constraint(constraint);
}

}  // namespace psi_slam
