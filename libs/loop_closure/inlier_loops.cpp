// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/inlier_loops.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "pose_graph/constraint_error.h"
#include "pose_graph/graduated_non_convexity.h"
#include "pose_graph/path_covariance.h"
#include "pose_graph/spanning_tree.h"

namespace psi_slam {
namespace {

void place_without_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                         const std::vector<std::size_t>& loops) {
  for (const std::size_t loop : loops) graph.set_enabled(loop, false);
  const std::vector<mrpt::math::TPose2D> poses = spanning_tree_poses(graph);
  for (std::size_t node = 0; node < poses.size(); ++node) graph.set_pose(node, poses[node]);
  solver.optimize(graph);
}

}  // namespace

std::vector<double> path_chi(const PoseGraph& graph, const std::vector<std::size_t>& loops) {
  std::map<std::size_t, std::vector<std::size_t>> by_start;  // indices of `loops`; one walk for each start
  for (std::size_t i = 0; i < loops.size(); ++i) by_start[graph.constraint(loops[i]).from].push_back(i);
  std::vector<double> chi(loops.size());
  PathCovarianceSearch search;
  for (const auto& [start, indices] : by_start) {
    PathCovarianceOptions to_ends;
    for (const std::size_t i : indices) to_ends.targets.push_back(graph.constraint(loops[i]).to);
    search.run(graph, start, to_ends);
    for (const std::size_t i : indices) {
      const Constraint& loop = graph.constraint(loops[i]);
      const RelativeUncertainty uncertainty = search.of(loop.to);
      if (!uncertainty.reached) continue;  // nothing is known of it: it contradicts nothing
      const Eigen::Vector3d error = constraint_error(loop.from_T_to, RotatedPose(graph.pose(loop.from)),
                                                     RotatedPose(graph.pose(loop.to)));
      const Eigen::Matrix3d covariance = uncertainty.covariance + loop.information.inverse();
      chi[i] = std::sqrt(std::max(0.0, error.dot(covariance.ldlt().solve(error))));
    }
  }
  return chi;
}

void trust_loops(PoseGraph& graph, SparsePoseAdjustment& solver, const std::vector<std::size_t>& loops,
                 double max_chi) {
  place_without_loops(graph, solver, loops);
  const std::vector<double> off_path = path_chi(graph, loops);
  for (std::size_t i = 0; i < loops.size(); ++i)
    graph.set_enabled(loops[i], off_path[i] <= kPathGate * max_chi);
  GraduatedOptions options;
  options.inlier_width = max_chi;
  const std::vector<ConstraintFit> fits = optimize_graduated(graph, solver, options).solution.fits;
  for (const std::size_t loop : loops) graph.set_enabled(loop, fits[loop].chi2 <= max_chi * max_chi);
  solver.optimize(graph);
}

}  // namespace psi_slam
