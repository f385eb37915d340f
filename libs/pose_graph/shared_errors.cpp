// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/shared_errors.h"

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <utility>

#include "logs/frames/pose_operations.h"
#include "pose_graph/information_matrix.h"
#include "pose_graph/marginal_covariance.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Eigen::Matrix3d;

Matrix3d inverse_of(const Matrix3d& matrix) {
  const Matrix3d inverse = matrix.inverse();
  if (!inverse.allFinite())
    throw UserError(
        "the information matrix of a loop of the pose graph is singular, so its covariance is unknown. Give "
        "each loop information about x, y and the heading.");
  return (inverse + inverse.transpose()) / 2;
}

/// All loops between two segments of the path.
struct Loops {
  Matrix3d information = Matrix3d::Zero();  ///< sum, in the axes of the map
  double count = 0;
};

}  // namespace

std::vector<std::size_t> segments_of(const PoseGraph& graph) {
  std::vector<std::size_t> first(graph.num_nodes());
  std::vector<char> is_first(graph.num_nodes(), 0);
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) first[node] = node;
  for (const Constraint& constraint : graph.constraints())
    if (constraint.kind == Constraint::Kind::kLocalMap) is_first[constraint.from] = 1;
  for (const Constraint& constraint : graph.constraints())
    if (constraint.kind == Constraint::Kind::kLocalMap && is_first[constraint.to] == 0)
      first[constraint.to] = constraint.from;
  return first;
}

PoseGraph graph_with_shared_errors(const PoseGraph& graph) {
  PoseGraph model;
  for (const mrpt::math::TPose2D& pose : graph.poses()) model.add_node(pose);
  if (graph.root() != 0) model.set_root(graph.root());
  const std::vector<std::size_t> segment_of = segments_of(graph);
  std::map<std::pair<std::size_t, std::size_t>, Loops> loops_between;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    if (!graph.enabled(i)) continue;
    Constraint constraint = graph.constraint(i);
    const auto ends = std::minmax<std::size_t>({segment_of[constraint.from], segment_of[constraint.to]});
    if (constraint.kind == Constraint::Kind::kLoop && ends.first != ends.second) {
      Loops& loops = loops_between[{ends.first, ends.second}];
      loops.information += in_turned_axes(constraint.information, graph.pose(constraint.from).phi);
      loops.count += 1;
      continue;
    }
    constraint.from_T_to = between(graph.pose(constraint.from), graph.pose(constraint.to));
    model.add_constraint(constraint);
  }
  for (const auto& [ends, loops] : loops_between) {
    const double share = kCommonLoopShare + (1 - kCommonLoopShare) / loops.count;
    Constraint constraint;
    constraint.kind = Constraint::Kind::kLoop;
    constraint.from = ends.first;
    constraint.to = ends.second;
    constraint.from_T_to = between(graph.pose(ends.first), graph.pose(ends.second));
    constraint.information = in_turned_axes(inverse_of(share * inverse_of(loops.information / loops.count)),
                                            -graph.pose(ends.first).phi);
    model.add_constraint(constraint);
  }
  return model;
}

std::vector<Matrix3d> pose_covariances(const PoseGraph& graph) {
  if (graph.num_nodes() == 0) return {};
  MarginalCovariance of_model;
  of_model.update(graph_with_shared_errors(graph));
  std::vector<Matrix3d> covariances = of_model.marginals();
  return covariances;
}

Matrix3d pose_covariance(const PoseGraph& graph, std::size_t node) {
  MarginalCovariance of_model;
  of_model.update(graph_with_shared_errors(graph));
  return of_model.marginal(node);
}

}  // namespace psi_slam
