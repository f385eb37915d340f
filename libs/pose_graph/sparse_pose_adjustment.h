// SPDX-License-Identifier: BSD-3-Clause
// Sparse pose adjustment (Konolige et al., "Efficient sparse pose adjustment for 2D mapping", IROS 2010):
// finds the poses that minimise E = sum rho_i(e_i^T Omega_i e_i) (equations 3 to 6). Levenberg-Marquardt
// minimises the weighted error with a sparse Cholesky factorisation; robust kernels rho enter by iterative
// reweighting.
//
// The solver differs from the paper in three points, which handle the large first errors of a long loop.
// Steps are Gauss-Newton steps until one fails. If E after a step far exceeds the linearised prediction, it
// solves for the headings alone and then for the positions alone. These two linear problems are solved at
// most once per call (Carlone et al., "A fast and accurate approximation for planar pose graph optimization",
// IJRR 2014). E may rise for two steps if it then reaches a new minimum (the watchdog of Chamberlain et al.,
// 1982); otherwise the steps are damped.
#pragma once

#include <vector>

#include "pose_graph/normal_equations.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct PoseAdjustmentOptions {
  int max_iterations = 50;           ///< largest number of steps, including rejected ones
  double relative_tolerance = 1e-6;  ///< converged if E can fall by at most this share of E
  double absolute_tolerance = 1e-9;  ///< decrease of E added to relative_tolerance times E
  double initial_lambda = 0;         ///< damping of the first step; 0 is a Gauss-Newton step
  RobustKernel odometry_kernel;      ///< kernel for constraints of the kinds kOdometry and kRunStart
  RobustKernel local_map_kernel;     ///< kernel for constraints of the kind kLocalMap
  /// Kernel for loops, and for constraints of the kind kKnown. Huber's kernel is convex, so that a true loop
  /// is closed after any drift. With a kernel that bounds the cost, a true loop may stay open. If loops can
  /// be false, use optimize_graduated().
  RobustKernel loop_kernel{RobustKernel::Type::kHuber, 3};
};

/// Kernel of a constraint: its own, or else that of its kind.
const RobustKernel& kernel_of(const Constraint& constraint, const PoseAdjustmentOptions& options);

/// Error and weight of one constraint at the solution.
struct ConstraintFit {
  double chi2 = 0;    ///< e^T Omega e, also for disabled constraints
  double weight = 1;  ///< weight by the robust kernel, in [0, 1]; 0 if disabled
};

/// Result of an optimisation. chi2 sums run over the enabled constraints; "final" means after the last step.
struct PoseAdjustmentReport {
  int iterations = 0;
  int rejected_steps = 0;  ///< steps that did not lower E, or could not be computed
  bool converged = false;
  double initial_chi2 = 0;  ///< sum of e^T Omega e before the first step, without kernels
  double final_chi2 = 0;
  double initial_robust_chi2 = 0;  ///< E before the first step, with the kernels
  double final_robust_chi2 = 0;
  double max_gradient = 0;  ///< largest |dE/dx| at the last linearised state with the lowest E so far
  double milliseconds = 0;
  bool structure_reused = false;    ///< whether the order and the layout of H were reused
  std::vector<ConstraintFit> fits;  ///< indexed by constraint
};

/// Solver for a growing graph. Keep the object between calls, because it reuses the structure of the graph.
/// It also accepts another graph.
class SparsePoseAdjustment {
 public:
  explicit SparsePoseAdjustment(PoseAdjustmentOptions options = {}) : options_(options) {}

  const PoseAdjustmentOptions& options() const { return options_; }
  void set_options(const PoseAdjustmentOptions& options) { options_ = options; }

  /// Moves the poses of the graph to a minimum of E; the pose of the root stays. Headings are in (-pi, pi].
  /// The final E never exceeds the initial E. Equal sequences of calls give equal results to the last bit.
  /// Throws unreachable_node(), a UserError, if a node is not linked to the root; the graph is then
  /// unchanged.
  PoseAdjustmentReport optimize(PoseGraph& graph);

  /// The normal equations as they were last linearised and factorised.
  const NormalEquations& equations() const { return equations_; }

 private:
  struct State {  // poses, and the errors of the constraints at these poses
    std::vector<RotatedPose> poses;
    std::vector<Eigen::Vector3d> errors;
    std::vector<double> chi2;
    double sum = 0;
    double robust_sum = 0;
  };

  struct Attempt {              // how trial_ was computed
    double promised = 0;        // predicted decrease of E
    bool from_current = false;  // trial_ solves the damped system, not headings and positions separately
  };

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

  // State of the current call of optimize():
  State best_;                   // state of the lowest E, while uphill_steps_ > 0
  State current_;                // state of the linearisation
  State trial_;                  // state after the step
  std::vector<double> weights_;  // weights of the constraints at current_
  double lambda_ = 0;            // damping of the next step
  double lowest_ = 0;            // lowest E: at best_ if uphill_steps_ > 0, otherwise at current_
  int uphill_steps_ = 0;         // number of steps since current_ left best_
  bool linearized_ = false;      // equations_ are linearised at current_
  bool headings_tried_ = false;
};

}  // namespace psi_slam
