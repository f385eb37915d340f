// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/aligned_uncertainty.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "pose_graph/marginal_covariance.h"
#include "pose_graph/placed_covariances.h"
#include "pose_graph/shared_errors.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Matrix23d = Eigen::Matrix<double, 2, 3>;

/// Displacements of the positions by three orthonormal rigid motions: along x, along y, and a turn about the
/// mean position. Row pairs belong to the nodes.
std::vector<Matrix23d> rigid_motions(const PoseGraph& graph, const std::vector<std::size_t>& nodes) {
  const auto position = [&](std::size_t node) {
    return Eigen::Vector2d(graph.pose(node).x, graph.pose(node).y);
  };
  const auto count = static_cast<double>(nodes.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const std::size_t node : nodes) mean += position(node) / count;
  double spread_m2 = 0;
  for (const std::size_t node : nodes) spread_m2 += (position(node) - mean).squaredNorm();
  const double per_turn = spread_m2 > 0 ? 1 / std::sqrt(spread_m2) : 0;
  std::vector<Matrix23d> motions;
  for (const std::size_t node : nodes) {
    const Eigen::Vector2d arm = per_turn * (position(node) - mean);
    Matrix23d motion;
    motion << 1 / std::sqrt(count), 0, -arm.y(), 0, 1 / std::sqrt(count), arm.x();
    motions.push_back(motion);
  }
  return motions;
}

/// Standard deviations of the positions of the given nodes of a graph whose nodes are all placed.
std::vector<double> sigmas_of_placed(const PoseGraph& graph, const std::vector<std::size_t>& nodes) {
  const PoseGraph model = graph_with_shared_errors(graph);
  MarginalCovariance covariance;
  covariance.update(model);
  const std::vector<Eigen::Matrix3d> marginals = covariance.marginals();
  // With C the covariance of all positions and Q the rigid motions, the covariance of the aligned positions
  // is (I - Q Q^T) C (I - Q Q^T). Its diagonal blocks need C Q and Q^T C Q.
  const std::vector<Matrix23d> motions = rigid_motions(graph, nodes);
  std::vector<Matrix23d> with_motions(nodes.size());
  for (int motion = 0; motion < 3; ++motion) {
    std::vector<Eigen::Vector3d> weights(model.num_nodes(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < nodes.size(); ++i) weights[nodes[i]].head<2>() = motions[i].col(motion);
    const std::vector<Eigen::Vector3d> covariances = covariance.covariances_with_sum(weights);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      with_motions[i].col(motion) = covariances[nodes[i]].head<2>();
  }
  Eigen::Matrix3d of_motions = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) of_motions += motions[i].transpose() * with_motions[i];
  std::vector<double> sigmas_m;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double variance_m2 = marginals[nodes[i]].topLeftCorner<2, 2>().trace() -
                               2 * (motions[i] * with_motions[i].transpose()).trace() +
                               (motions[i] * of_motions * motions[i].transpose()).trace();
    sigmas_m.push_back(std::sqrt(std::max(0.0, variance_m2)));
  }
  return sigmas_m;
}

}  // namespace

std::vector<std::optional<double>> aligned_sigmas_m(const PoseGraph& graph,
                                                    const std::vector<std::size_t>& nodes) {
  std::vector<std::optional<double>> sigmas_m(nodes.size());
  const PlacedPart placed = placed_part(graph);
  std::vector<std::size_t> indices;  // in `nodes`
  std::vector<std::size_t> chosen;   // numbers of these nodes in the placed part
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto found = std::lower_bound(placed.nodes.begin(), placed.nodes.end(), nodes[i]);
    if (found == placed.nodes.end() || *found != nodes[i]) continue;
    indices.push_back(i);
    chosen.push_back(static_cast<std::size_t>(found - placed.nodes.begin()));
  }
  if (chosen.empty()) return sigmas_m;
  try {
    const std::vector<double> of_placed = sigmas_of_placed(placed.graph, chosen);
    for (std::size_t i = 0; i < indices.size(); ++i) sigmas_m[indices[i]] = of_placed[i];
  } catch (const UserError&) {  // a constraint is singular
  }
  return sigmas_m;
}

}  // namespace psi_slam
