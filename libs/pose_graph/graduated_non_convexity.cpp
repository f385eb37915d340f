// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/graduated_non_convexity.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Squared width so large that the kernel gives every error the same weight.
constexpr double kNearlyConvexWidth2 = 1e20;

/// A loop with a kernel of its own is no candidate: a person stated it.
bool is_enabled_loop(const PoseGraph& graph, std::size_t index) {
  const Constraint& constraint = graph.constraint(index);
  return graph.enabled(index) && constraint.kind == Constraint::Kind::kLoop && !constraint.kernel;
}

double largest_loop_chi2(const PoseGraph& graph, const std::vector<ConstraintFit>& fits) {
  double largest = 0;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (is_enabled_loop(graph, i)) largest = std::max(largest, fits[i].chi2);
  return largest;
}

void set_poses(PoseGraph& graph, const std::vector<TPose2D>& poses) {
  for (std::size_t node = 0; node < poses.size(); ++node) graph.set_pose(node, poses[node]);
}

// Restores the options of the solver at the end of the scope.
class OptionsGuard {
 public:
  explicit OptionsGuard(SparsePoseAdjustment& solver) : solver_(solver), options_(solver.options()) {}
  ~OptionsGuard() { solver_.set_options(options_); }
  OptionsGuard(const OptionsGuard&) = delete;
  OptionsGuard& operator=(const OptionsGuard&) = delete;

 private:
  SparsePoseAdjustment& solver_;
  PoseAdjustmentOptions options_;
};

}  // namespace

GraduatedReport optimize_graduated(PoseGraph& graph, SparsePoseAdjustment& solver,
                                   const GraduatedOptions& options) {
  const OptionsGuard guard(solver);
  const PoseAdjustmentOptions given = solver.options();
  const double inlier_width2 = options.inlier_width * options.inlier_width;
  double milliseconds = 0;
  const auto solve = [&](double loop_width2, int max_iterations) {
    PoseAdjustmentOptions round = given;
    round.max_iterations = max_iterations;
    round.loop_kernel = {RobustKernel::Type::kGemanMcClure, std::sqrt(loop_width2)};
    solver.set_options(round);
    PoseAdjustmentReport report = solver.optimize(graph);
    milliseconds += report.milliseconds;
    return report;
  };

  GraduatedReport report;
  const std::vector<TPose2D> start = graph.poses();
  const PoseAdjustmentReport from_start = solve(inlier_width2, given.max_iterations);
  const std::vector<TPose2D> narrow_poses = graph.poses();

  set_poses(graph, start);
  const PoseAdjustmentReport convex = solve(kNearlyConvexWidth2, options.first_iterations);
  for (double width2 = 2 * largest_loop_chi2(graph, convex.fits);
       width2 > inlier_width2 && report.rounds < options.max_rounds; width2 /= options.narrowing) {
    solve(width2, options.iterations_per_round);
    ++report.rounds;
  }
  report.solution = solve(inlier_width2, given.max_iterations);
  if (from_start.final_robust_chi2 < report.solution.final_robust_chi2) {
    report.solution = from_start;
    set_poses(graph, narrow_poses);
  }
  report.solution.initial_chi2 = from_start.initial_chi2;
  report.solution.initial_robust_chi2 = from_start.initial_robust_chi2;
  report.solution.milliseconds = milliseconds;
  for (std::size_t i = 0; i < report.solution.fits.size(); ++i) {
    if (is_enabled_loop(graph, i) && report.solution.fits[i].chi2 > inlier_width2)
      report.outliers.push_back(i);
  }
  return report;
}

}  // namespace psi_slam
