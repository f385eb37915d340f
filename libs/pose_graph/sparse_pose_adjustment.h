// SPDX-License-Identifier: BSD-3-Clause
// Sparse pose adjustment (Konolige et al., "Efficient sparse pose adjustment for 2D mapping", IROS 2010):
// finds the poses that minimise E = sum rho_i(e_i^T Omega_i e_i) (equations 3 to 6) by Levenberg-Marquardt on
// the weighted error with a sparse Cholesky factorisation; robust kernels rho enter by iterative reweighting.
//
// It departs from the paper in three points, all for the large first errors of a long loop. The steps are
// plain Gauss-Newton ones until one fails. Where E turns out far from what the linearisation promised, the
// solution of the headings alone and then of the positions alone, both linear problems, competes with the
// step, once a call (Carlone et al., "A fast and accurate approximation for planar pose graph optimization",
// IJRR 2014). E may rise for two steps if it is lower than ever after them (the watchdog of Chamberlain et
// al., 1982); only where it is not are the steps damped.
#pragma once

#include <cstddef>
#include <vector>

#include "pose_graph/normal_equations.h"
#include "psi_slam/pose_graph.h"
#include "pose_graph/robust_kernel.h"

namespace psi_slam {

struct PoseAdjustmentOptions {
  int max_iterations = 50;           ///< steps computed, rejected ones included
  double relative_tolerance = 1e-6;  ///< converged when E can fall by no more than this share of itself, ...
  double absolute_tolerance = 1e-9;  ///< ... or by no more than this
  double initial_lambda = 0;         ///< of the first step; 0: Gauss-Newton
  RobustKernel odometry_kernel;      ///< of the constraints between successive nodes
  RobustKernel local_map_kernel;     ///< of those of nodes to their local maps
  /// Convex, so that it closes a true loop however far the map has drifted; kernels that bound the cost leave
  /// such a loop open. Where loops may be false, see optimize_graduated().
  RobustKernel loop_kernel{RobustKernel::Type::kHuber, 3};
};

/// One constraint at the solution.
struct ConstraintFit {
  double chi2 = 0;    ///< e^T Omega e; of disabled constraints too
  double weight = 1;  ///< by the robust kernel, in [0, 1]; 0 when disabled
};

struct PoseAdjustmentReport {
  int iterations = 0;
  int rejected_steps = 0;       ///< that did not lower E, or could not be computed
  bool headings_first = false;  ///< the separate solution of headings and positions was taken
  bool converged = false;
  double initial_chi2 = 0;  ///< plain sum of e^T Omega e
  double final_chi2 = 0;
  double initial_robust_chi2 = 0;  ///< E, with the kernels
  double final_robust_chi2 = 0;
  double max_gradient = 0;  ///< largest |dE/dx| where H was last computed
  double milliseconds = 0;
  bool structure_reused = false;    ///< neither order nor layout had to be found
  std::vector<ConstraintFit> fits;  ///< by the constraint's number
};

/// A solver for one graph that grows: keep it between calls, it keeps what it can. Any other graph may be
/// given too.
class SparsePoseAdjustment {
 public:
  explicit SparsePoseAdjustment(PoseAdjustmentOptions options = {}) : options_(options) {}

  const PoseAdjustmentOptions& options() const { return options_; }
  void set_options(const PoseAdjustmentOptions& options) { options_ = options; }

  /// Moves the graph's poses to a minimum of E; the root stays. Headings end in (-pi, pi]. E never rises. The
  /// same graph gives the same result to the last bit when the same calls came before. Throws UserError when
  /// a node is not linked to the root (see NormalEquations::prepare); the graph is untouched then.
  PoseAdjustmentReport optimize(PoseGraph& graph);

  /// The system as it was last linearised and factorised.
  const NormalEquations& equations() const { return equations_; }

 private:
  struct State {  // a set of poses and what the constraints say to it
    std::vector<RotatedPose> poses;
    std::vector<Eigen::Vector3d> errors;
    std::vector<double> chi2;
    double sum = 0;
    double robust_sum = 0;
  };

  struct Attempt {              // what trial_ is
    double promised = 0;        // decrease of E by the linearisation
    bool from_current = false;  // trial_ solves the damped system, not headings and positions apart
  };

  const RobustKernel& kernel_of(const Constraint& constraint) const;
  void evaluate(const PoseGraph& graph, State& state) const;
  void move(const PoseGraph& graph, const State& from, const Eigen::VectorXd& step, State& to) const;
  void begin(const PoseGraph& graph);
  void linearize(const PoseGraph& graph, PoseAdjustmentReport& report);
  Attempt attempt_step(const PoseGraph& graph);
  bool solve_headings_first(const PoseGraph& graph, State& result);
  bool judge(const Attempt& attempt, PoseAdjustmentReport& report);
  void reject();
  double negligible() const;

  PoseAdjustmentOptions options_;
  NormalEquations equations_;

  // Of the call of optimize() under way:
  State best_;                   // the lowest E so far, while current_ is an excursion from it
  State current_;                // where the system is linearised
  State trial_;                  // where a step leads
  std::vector<double> weights_;  // of the constraints at current_
  double lambda_ = 0;            // damping of the next step
  double lowest_ = 0;            // E at best_, or at current_ when that is no excursion
  int uphill_steps_ = 0;         // since current_ left best_
  bool linearized_ = false;      // at current_
  bool headings_tried_ = false;
};

}  // namespace psi_slam
