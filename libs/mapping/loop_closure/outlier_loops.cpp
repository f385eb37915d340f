// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/outlier_loops.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pose_graph/constraint_error.h"
#include "pose_graph/doubtful_graph.h"
#include "pose_graph/graduated_non_convexity.h"
#include "pose_graph/marginal_covariance.h"
#include "pose_graph/shared_errors.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

std::vector<double> optimized_chi(PoseGraph& graph, SparsePoseAdjustment& solver,
                                  const std::vector<std::size_t>& loops) {
  const std::vector<ConstraintFit> fits = solver.optimize(graph).fits;
  std::vector<double> chi;
  for (const std::size_t loop : loops) chi.push_back(std::sqrt(fits[loop].chi2));
  return chi;
}

void disable(PoseGraph& graph, const std::vector<std::size_t>& loops) {
  for (const std::size_t loop : loops) graph.set_enabled(loop, false);
}

// Enables the loops that fit, such as those that contradicted false loops which were rejected later. Returns
// whether there were any.
bool enable_fitting(PoseGraph& graph, const std::vector<std::size_t>& loops, const std::vector<double>& chi) {
  bool any = false;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (graph.enabled(loops[i]) || chi[i] > kInlierChi) continue;
    graph.set_enabled(loops[i], true);
    any = true;
  }
  return any;
}

}  // namespace

std::vector<double> reject_outlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                                         const std::vector<std::size_t>& loops) {
  for (const std::size_t loop : loops) graph.set_enabled(loop, true);
  std::vector<double> chi = optimized_chi(graph, solver, loops);
  if (std::all_of(chi.begin(), chi.end(), [](double one) { return one <= kInlierChi; })) return chi;
  PoseGraph doubtful = doubtful_graph(graph);
  disable(graph, optimize_graduated(doubtful, solver).outliers);
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) graph.set_pose(node, doubtful.pose(node));
  disable(graph, optimize_graduated(graph, solver).outliers);
  chi = optimized_chi(graph, solver, loops);
  while (enable_fitting(graph, loops, chi)) chi = optimized_chi(graph, solver, loops);
  return chi;
}

std::optional<double> contradiction(const Constraint& constraint, const PoseGraph& rest) {
  MarginalCovariance of_rest;
  try {
    of_rest.update(graph_with_shared_errors(rest));
  } catch (const UserError&) {
    return std::nullopt;
  }
  const Eigen::Matrix3d covariance =
      constraint.information.inverse() + of_rest.relative(constraint.from, constraint.to);
  const Eigen::Vector3d error = constraint_error(
      constraint.from_T_to, RotatedPose(rest.pose(constraint.from)), RotatedPose(rest.pose(constraint.to)));
  return std::sqrt(std::max(0.0, error.dot(covariance.inverse() * error)));
}

}  // namespace psi_slam
