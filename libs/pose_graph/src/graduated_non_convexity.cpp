// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/pose_graph/graduated_non_convexity.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

double largest_loop_chi2(const PoseGraph& graph, const std::vector<ConstraintFit>& fits) {
  double largest = 0;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (graph.enabled(i) && graph.constraints()[i].kind == Constraint::Kind::kLoop)
      largest = std::max(largest, fits[i].chi2);
  return largest;
}

// Gives the solver its options back, whatever happens.
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
  const PoseAdjustmentOptions final_options = solver.options();
  PoseAdjustmentOptions round_options = final_options;
  round_options.loop_kernel = {};
  const PoseAdjustmentReport convex = (solver.set_options(round_options), solver.optimize(graph));
  double milliseconds = convex.milliseconds;

  GraduatedReport report;
  const double inlier_width2 = options.inlier_width * options.inlier_width;
  double width2 = 2 * largest_loop_chi2(graph, convex.fits);
  round_options.max_iterations = options.iterations_per_round;
  for (; width2 > inlier_width2 && report.rounds < options.max_rounds; width2 /= options.narrowing) {
    round_options.loop_kernel = {RobustKernel::Type::kGemanMcClure, std::sqrt(width2)};
    solver.set_options(round_options);
    milliseconds += solver.optimize(graph).milliseconds;
    ++report.rounds;
  }
  round_options.max_iterations = final_options.max_iterations;
  round_options.loop_kernel = {RobustKernel::Type::kGemanMcClure, options.inlier_width};
  solver.set_options(round_options);
  report.solution = solver.optimize(graph);
  report.solution.milliseconds += milliseconds;
  report.solution.initial_chi2 = convex.initial_chi2;
  report.solution.initial_robust_chi2 = convex.initial_robust_chi2;
  for (std::size_t i = 0; i < report.solution.fits.size(); ++i)
    if (graph.enabled(i) && graph.constraints()[i].kind == Constraint::Kind::kLoop &&
        report.solution.fits[i].chi2 > inlier_width2)
      report.outliers.push_back(i);
  return report;
}

}  // namespace psi_slam
