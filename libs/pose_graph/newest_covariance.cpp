// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/newest_covariance.h"

#include <algorithm>
#include <optional>

namespace psi_slam {
namespace {

using Eigen::Matrix3d;

// Growth of the graph, as a share of its nodes, after which the covariance is computed again.
constexpr double kGrowth = 0.02;
constexpr double kGrowthWithLoops = 0.005;

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
  return drift_covariance(graph, graph.num_nodes() - 1, mean_local_map_).value_or(Matrix3d::Zero());
}

bool NewestCovariance::is_due(std::size_t nodes) const {
  const double share = gained_loops_ ? kGrowthWithLoops : kGrowth;
  return static_cast<double>(nodes - computed_nodes_) >= std::max(1.0, share * static_cast<double>(nodes));
}

// Returns false if the model has no drift to one of the new nodes.
bool NewestCovariance::carry_to_newest(const PoseGraph& graph) {
  for (std::size_t node = nodes_; node < graph.num_nodes(); ++node) {
    const std::optional<Matrix3d> drift = drift_covariance(graph, node, mean_local_map_);
    if (!drift) return false;
    covariance_ = carried_covariance(covariance_, graph.pose(node - 1), graph.pose(node)) + *drift;
  }
  return true;
}

void NewestCovariance::compute(const PoseGraph& graph) {
  covariance_ = pose_covariance(graph, graph.num_nodes() - 1);
  mean_local_map_ = mean_local_map(graph);
  computed_nodes_ = graph.num_nodes();
  gained_loops_ = false;
  ++computations_;
}

}  // namespace psi_slam
