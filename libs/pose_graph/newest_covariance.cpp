// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/newest_covariance.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "pose_graph/information_matrix.h"
#include "pose_graph/marginal_covariance.h"
#include "pose_graph/shared_errors.h"

namespace psi_slam {
namespace {

using Eigen::Matrix3d;

// Growth of the graph, as a share of its nodes, after which the covariance is computed again.
constexpr double kGrowth = 0.02;
constexpr double kGrowthWithLoops = 0.005;

// Constraint of the path to a node. The covariance is in the axes of the map.
struct PathLink {
  std::size_t from = 0;
  Matrix3d covariance;
};

std::optional<PathLink> path_link(const PoseGraph& graph, std::size_t node) {
  for (const std::uint32_t i : graph.constraints_of(node)) {
    const Constraint& constraint = graph.constraint(i);
    if (constraint.kind != Constraint::Kind::kLocalMap || constraint.to != node) continue;
    const Matrix3d covariance = constraint.information.inverse();
    return PathLink{constraint.from, in_turned_axes(covariance, graph.pose(constraint.from).phi)};
  }
  return std::nullopt;
}

}  // namespace

Matrix3d carried_covariance(const Matrix3d& covariance, const mrpt::math::TPose2D& begin,
                            const mrpt::math::TPose2D& end) {
  Matrix3d derivative = Matrix3d::Identity();  // of the pose at the end by the pose at the beginning
  derivative(0, 2) = begin.y - end.y;
  derivative(1, 2) = end.x - begin.x;
  return derivative * covariance * derivative.transpose();
}

const Matrix3d& NewestCovariance::update(const PoseGraph& graph) {
  // Constraints of local maps alone place the newest nodes. All others change the covariances of earlier
  // nodes.
  for (; constraints_ < graph.num_constraints(); ++constraints_)
    gained_loops_ = gained_loops_ || graph.constraint(constraints_).kind != Constraint::Kind::kLocalMap;
  if (graph.num_nodes() > 1 && (is_due(graph.num_nodes()) || !carry_to_newest(graph))) compute(graph);
  nodes_ = graph.num_nodes();
  return covariance_;
}

Matrix3d NewestCovariance::newest_drift(const PoseGraph& graph) const {
  if (graph.num_nodes() < 2) return Matrix3d::Zero();
  std::size_t end = graph.num_nodes() - 1;
  std::optional<PathLink> link = path_link(graph, end);
  if (!link) return Matrix3d::Zero();
  // From segment to segment, because the link of a single node holds the error of its scan, too.
  if (const std::optional<PathLink> whole = path_link(graph, link->from)) {
    end = link->from;
    link = whole;
  }
  return link->covariance / static_cast<double>(end - link->from);
}

bool NewestCovariance::is_due(std::size_t nodes) const {
  const double share = gained_loops_ ? kGrowthWithLoops : kGrowth;
  return static_cast<double>(nodes - computed_nodes_) >= std::max(1.0, share * static_cast<double>(nodes));
}

// Returns false if the path does not lead to one of the new nodes.
bool NewestCovariance::carry_to_newest(const PoseGraph& graph) {
  for (std::size_t node = nodes_; node < graph.num_nodes(); ++node) {
    const std::optional<PathLink> link = path_link(graph, node);
    if (!link) return false;
    if (link->from == node - 1) {
      first_ = link->from;
      first_covariance_ = covariance_;
    }
    if (link->from != first_) return false;
    covariance_ =
        carried_covariance(first_covariance_, graph.pose(first_), graph.pose(node)) + link->covariance;
  }
  return true;
}

void NewestCovariance::compute(const PoseGraph& graph) {
  const std::size_t newest = graph.num_nodes() - 1;
  const std::optional<PathLink> link = path_link(graph, newest);
  first_ = link ? link->from : newest;
  MarginalCovariance of_model;
  of_model.update(graph_with_shared_errors(graph));
  covariance_ = of_model.marginal(newest);
  first_covariance_ = of_model.marginal(first_);
  computed_nodes_ = graph.num_nodes();
  gained_loops_ = false;
  ++computations_;
}

}  // namespace psi_slam
