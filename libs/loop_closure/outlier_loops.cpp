// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/outlier_loops.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "loop_closure/agreeing_loops.h"
#include "pose_graph/changed_path.h"
#include "pose_graph/constraint_error.h"
#include "pose_graph/graduated_non_convexity.h"
#include "pose_graph/path_covariance.h"
#include "pose_graph/spanning_tree.h"

namespace psi_slam {
namespace {

// Loops with at least this share of the worst residual are disabled in the same round.
constexpr double kShareOfWorst = 0.5;

// Factor on the standard deviations of the front end's constraints if its path may be bent.
constexpr double kLoosening = 5;

// Share of all loops that must agree along a bent path. So false loops cannot bend it unless nearly all of
// them agree with the true ones.
constexpr double kNearlyAll = 0.95;

std::vector<double> optimized_chi(PoseGraph& graph, SparsePoseAdjustment& solver,
                                  const std::vector<std::size_t>& loops) {
  const std::vector<ConstraintFit> fits = solver.optimize(graph).fits;
  std::vector<double> chi;
  for (const std::size_t loop : loops) chi.push_back(std::sqrt(fits[loop].chi2));
  return chi;
}

// Disables the worst loops and optimises, until no loop is contradicted. Every round disables at least one
// loop. Never disables the loops that `kept` marks.
void switch_off_worst_first(PoseGraph& graph, SparsePoseAdjustment& solver,
                            const std::vector<std::size_t>& loops, double max_chi,
                            const std::vector<bool>& kept, std::vector<double>& chi) {
  while (true) {
    double worst = 0;
    for (std::size_t i = 0; i < loops.size(); ++i)
      if (!kept[i] && graph.enabled(loops[i])) worst = std::max(worst, chi[i]);
    if (worst <= max_chi) return;
    for (std::size_t i = 0; i < loops.size(); ++i)
      if (!kept[i] && chi[i] > max_chi && chi[i] >= kShareOfWorst * worst) graph.set_enabled(loops[i], false);
    chi = optimized_chi(graph, solver, loops);
  }
}

// Marks the disabled loops that path_chi() does not contradict.
std::vector<bool> plausible_along_path(const PoseGraph& graph, const std::vector<std::size_t>& loops,
                                       double max_chi) {
  std::vector<std::size_t> disabled;
  for (const std::size_t loop : loops)
    if (!graph.enabled(loop)) disabled.push_back(loop);
  const std::vector<double> off_path = path_chi(graph, disabled);
  std::vector<bool> plausible;
  auto chi = off_path.begin();
  for (const std::size_t loop : loops)
    plausible.push_back(!graph.enabled(loop) && *chi++ <= kPlausibleShare * max_chi);
  return plausible;
}

double contradicted_share(const PoseGraph& graph, const std::vector<std::size_t>& loops, double max_chi,
                          const std::vector<double>& chi) {
  std::size_t on = 0;
  std::size_t contradicted = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!graph.enabled(loops[i])) continue;
    ++on;
    contradicted += chi[i] > max_chi ? 1 : 0;
  }
  return on == 0 ? 0 : static_cast<double>(contradicted) / static_cast<double>(on);
}

void place_without_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                         const std::vector<std::size_t>& loops) {
  for (const std::size_t loop : loops) graph.set_enabled(loop, false);
  const std::vector<mrpt::math::TPose2D> poses = spanning_tree_poses(graph);
  for (std::size_t node = 0; node < poses.size(); ++node) graph.set_pose(node, poses[node]);
  solver.optimize(graph);
}

// Enables the disabled loops that fit after all or that `plausible` marks, and optimises. Returns whether
// there were any.
bool enable_fitting(PoseGraph& graph, SparsePoseAdjustment& solver, const std::vector<std::size_t>& loops,
                    double max_chi, const std::vector<bool>& plausible, std::vector<double>& chi) {
  bool any_fits = false;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (graph.enabled(loops[i]) || (chi[i] > max_chi && !plausible[i])) continue;
    graph.set_enabled(loops[i], true);
    any_fits = true;
  }
  if (any_fits) chi = optimized_chi(graph, solver, loops);
  return any_fits;
}

// Disables the worst loops first. Then enables those that fit after all.
void settle(PoseGraph& graph, SparsePoseAdjustment& solver, const std::vector<std::size_t>& loops,
            double max_chi, std::vector<double>& chi) {
  switch_off_worst_first(graph, solver, loops, max_chi, std::vector<bool>(loops.size()), chi);
  const std::vector<bool> plausible = plausible_along_path(graph, loops, max_chi);
  if (!enable_fitting(graph, solver, loops, max_chi, plausible, chi)) return;
  switch_off_worst_first(graph, solver, loops, max_chi, plausible, chi);
}

std::size_t enabled_loops(const PoseGraph& graph, const std::vector<std::size_t>& loops) {
  return static_cast<std::size_t>(
      std::count_if(loops.begin(), loops.end(), [&](std::size_t loop) { return graph.enabled(loop); }));
}

// Enables the loops that agree in a copy of the graph, instead of those that contradict them. Takes the copy
// over and returns true if it has more loops than before, by at least half of those that agree.
bool prefer_agreeing(PoseGraph& graph, SparsePoseAdjustment& solver, const std::vector<std::size_t>& loops,
                     double max_chi, std::vector<double>& chi) {
  const std::vector<std::size_t> agreeing = agreeing_loops(graph, loops);
  std::set<std::size_t> nodes;
  for (const std::size_t i : agreeing) nodes.insert(graph.constraint(loops[i]).to);
  if (nodes.size() < kFewestAgreeingNodes) return false;
  PoseGraph trial = graph;
  std::vector<bool> kept(loops.size());
  for (const std::size_t i : agreeing) {
    trial.set_enabled(loops[i], true);
    kept[i] = true;
  }
  std::vector<double> trial_chi = optimized_chi(trial, solver, loops);
  switch_off_worst_first(trial, solver, loops, max_chi, kept, trial_chi);
  settle(trial, solver, loops, max_chi, trial_chi);
  if (enabled_loops(trial, loops) < enabled_loops(graph, loops) + agreeing.size() / 2) return false;
  graph = std::move(trial);
  chi = std::move(trial_chi);
  return true;
}

// Returns the graph with kLoosening times as large standard deviations of the front end's constraints.
PoseGraph loosened(const PoseGraph& graph) {
  return with_changed_path(graph,
                           [](Constraint& constraint) { constraint.information /= kLoosening * kLoosening; });
}

// Selects consistent loops in the graph with a loosened path. Enables these, and loops that then fit, if they
// are nearly all loops and disabled loops of enough nodes are among them.
void prefer_bent_path(PoseGraph& graph, SparsePoseAdjustment& solver, const std::vector<std::size_t>& loops,
                      double max_chi, std::vector<double>& chi) {
  std::set<std::size_t> nodes;
  for (const std::size_t loop : loops)
    if (!graph.enabled(loop)) nodes.insert(graph.constraint(loop).to);
  if (nodes.size() < kFewestAgreeingNodes) return;
  PoseGraph trial = loosened(graph);
  select_inlier_loops(trial, solver, loops, max_chi);
  if (static_cast<double>(enabled_loops(trial, loops)) < kNearlyAll * static_cast<double>(loops.size()))
    return;
  for (const std::size_t loop : loops) graph.set_enabled(loop, trial.enabled(loop));
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) graph.set_pose(node, trial.pose(node));
  chi = optimized_chi(graph, solver, loops);
  enable_fitting(graph, solver, loops, max_chi, std::vector<bool>(loops.size()), chi);
}

}  // namespace

std::vector<double> switch_off_outlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                                             const std::vector<std::size_t>& loops, double max_chi,
                                             double doubtful_share) {
  std::vector<double> chi = optimized_chi(graph, solver, loops);
  if (contradicted_share(graph, loops, max_chi, chi) > doubtful_share) {
    select_inlier_loops(graph, solver, loops, max_chi);
    chi = optimized_chi(graph, solver, loops);
  }
  settle(graph, solver, loops, max_chi, chi);
  while (prefer_agreeing(graph, solver, loops, max_chi, chi)) {
  }
  const std::size_t off = loops.size() - enabled_loops(graph, loops);
  if (static_cast<double>(off) > doubtful_share * static_cast<double>(loops.size()))
    prefer_bent_path(graph, solver, loops, max_chi, chi);
  return chi;
}

std::vector<double> path_chi(const PoseGraph& graph, const std::vector<std::size_t>& loops) {
  // Indices into `loops` by start node. One search serves all loops of a start node.
  std::map<std::size_t, std::vector<std::size_t>> by_start;
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
      if (!uncertainty.reached) continue;  // no path contradicts the loop
      const Eigen::Vector3d error = constraint_error(loop.from_T_to, RotatedPose(graph.pose(loop.from)),
                                                     RotatedPose(graph.pose(loop.to)));
      const Eigen::Matrix3d covariance = uncertainty.covariance + loop.information.inverse();
      chi[i] = std::sqrt(std::max(0.0, error.dot(covariance.ldlt().solve(error))));
    }
  }
  return chi;
}

void select_inlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                         const std::vector<std::size_t>& loops, double max_chi) {
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
