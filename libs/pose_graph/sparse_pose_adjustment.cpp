// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/sparse_pose_adjustment.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace psi_slam {
namespace {

// Damping after the first rejected step, and its factors for further steps.
constexpr double kFirstLambda = 1e-5;
constexpr double kLambdaUp = 10;
constexpr double kLambdaDown = 0.1;
constexpr double kMinLambda = 1e-8;  // a smaller damping is set to 0
constexpr double kMaxLambda = 1e10;  // a larger damping ends the optimisation
// Convergence is tested only up to this damping: strong damping makes all decreases small.
constexpr double kMaxLambdaOfConvergence = 1e-3;

constexpr int kMaxUphillSteps = 2;
// The linearisation is poor if E after a step exceeds the predicted E by this factor.
constexpr double kPoorPrediction = 10;

}  // namespace

const RobustKernel& kernel_of(const Constraint& constraint, const PoseAdjustmentOptions& options) {
  if (constraint.kernel) return *constraint.kernel;
  switch (constraint.kind) {
    case Constraint::Kind::kOdometry:
    case Constraint::Kind::kRunStart:
      return options.odometry_kernel;
    case Constraint::Kind::kLocalMap:
      return options.local_map_kernel;
    case Constraint::Kind::kLoop:
    case Constraint::Kind::kKnown:
      break;
  }
  return options.loop_kernel;
}

void SparsePoseAdjustment::evaluate(const PoseGraph& graph, State& state) const {
  const std::size_t count = graph.num_constraints();
  state.errors.resize(count);
  state.chi2.resize(count);
  state.sum = 0;
  state.robust_sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Constraint& constraint = graph.constraints()[i];
    const Eigen::Vector3d error =
        constraint_error(constraint.from_T_to, state.poses[constraint.from], state.poses[constraint.to]);
    state.errors[i] = error;
    state.chi2[i] = std::max(0.0, error.dot(constraint.information * error));
    if (!graph.enabled(i)) continue;
    state.sum += state.chi2[i];
    state.robust_sum += kernel_of(constraint, options_).cost(state.chi2[i]);
  }
}

void SparsePoseAdjustment::move(const PoseGraph& graph, const State& from, const Eigen::VectorXd& step,
                                State& to) const {
  to.poses.resize(from.poses.size());
  for (std::size_t node = 0; node < from.poses.size(); ++node) {
    const std::uint32_t variable = equations_.variable_of(node);
    if (variable == NormalEquations::kHeld) {
      to.poses[node] = from.poses[node];
      continue;
    }
    const auto delta = step.segment<3>(3 * static_cast<Eigen::Index>(variable));
    const RotatedPose& pose = from.poses[node];
    to.poses[node] =
        RotatedPose({pose.x + delta.x(), pose.y + delta.y(), wrap_to_pi(pose.theta + delta.z())});
  }
  evaluate(graph, to);
}

double SparsePoseAdjustment::negligible() const {
  return options_.absolute_tolerance + options_.relative_tolerance * lowest_;
}

void SparsePoseAdjustment::begin(const PoseGraph& graph) {
  equations_.prepare(graph);
  current_.poses = rotated(graph.poses());
  evaluate(graph, current_);
  lambda_ = options_.initial_lambda;
  lowest_ = current_.robust_sum;
  uphill_steps_ = 0;
  linearized_ = false;
  headings_tried_ = false;
}

void SparsePoseAdjustment::linearize(const PoseGraph& graph, PoseAdjustmentReport& report) {
  weights_.resize(graph.num_constraints());
  for (std::size_t i = 0; i < weights_.size(); ++i)
    weights_[i] = graph.enabled(i) ? kernel_of(graph.constraints()[i], options_).weight(current_.chi2[i]) : 0;
  equations_.linearize(graph, current_.poses, current_.errors, weights_);
  if (uphill_steps_ == 0) report.max_gradient = equations_.max_gradient();
  linearized_ = true;
}

// Computes trial_: the state after the damped step, or the separate solution of headings and positions if
// that has a lower E. E of trial_ is infinite if neither can be computed.
SparsePoseAdjustment::Attempt SparsePoseAdjustment::attempt_step(const PoseGraph& graph) {
  Attempt attempt;
  attempt.from_current = equations_.factorize(lambda_);
  if (attempt.from_current) {
    const Eigen::VectorXd step = equations_.step();
    attempt.promised = equations_.predicted_decrease(step, lambda_);
    move(graph, current_, step, trial_);
  } else {
    trial_.robust_sum = std::numeric_limits<double>::infinity();
  }
  const double expected = std::max(current_.robust_sum - attempt.promised, negligible());
  if (headings_tried_ || trial_.robust_sum <= kPoorPrediction * expected) return attempt;
  headings_tried_ = true;
  linearized_ = false;
  State separate;
  if (solve_headings_first(graph, separate) && !(trial_.robust_sum <= separate.robust_sum)) {
    std::swap(trial_, separate);
    attempt.from_current = false;
  }
  return attempt;
}

// Solves for the headings and then for the positions, starting from current_ with its weights. Returns false
// if a factorisation fails.
bool SparsePoseAdjustment::solve_headings_first(const PoseGraph& graph, State& result) {
  using Coordinates = NormalEquations::Coordinates;
  State turned;
  equations_.linearize(graph, current_.poses, current_.errors, weights_, Coordinates::kHeadings);
  if (!equations_.factorize(0)) return false;
  move(graph, current_, equations_.step(), turned);
  equations_.linearize(graph, turned.poses, turned.errors, weights_, Coordinates::kPositions);
  if (!equations_.factorize(0)) return false;
  move(graph, turned, equations_.step(), result);
  return true;
}

// Accepts or rejects trial_. Returns true if the optimisation has converged.
bool SparsePoseAdjustment::judge(const Attempt& attempt, PoseAdjustmentReport& report) {
  const bool may_converge = attempt.from_current && uphill_steps_ == 0 && lambda_ <= kMaxLambdaOfConvergence;
  if (trial_.robust_sum <= lowest_) {  // the comparison is false for NaN
    const bool converged = may_converge && lowest_ - trial_.robust_sum <= negligible();
    std::swap(current_, trial_);
    lowest_ = current_.robust_sum;
    uphill_steps_ = 0;
    linearized_ = false;
    lambda_ = lambda_ * kLambdaDown < kMinLambda ? 0 : lambda_ * kLambdaDown;
    return converged;
  }
  if (may_converge && attempt.promised <= negligible()) return true;  // at the minimum up to rounding
  ++report.rejected_steps;
  reject();
  return false;
}

// Continues from trial_ for some steps although E rose, or returns to the best state and damps the next step.
void SparsePoseAdjustment::reject() {
  if (lambda_ == 0 && uphill_steps_ < kMaxUphillSteps && std::isfinite(trial_.robust_sum)) {
    if (uphill_steps_ == 0) best_ = current_;
    ++uphill_steps_;
    std::swap(current_, trial_);
    linearized_ = false;
    return;
  }
  if (uphill_steps_ > 0) {
    std::swap(current_, best_);
    linearized_ = false;
  }
  uphill_steps_ = 0;
  lambda_ = std::max(kFirstLambda, lambda_ * kLambdaUp);
}

PoseAdjustmentReport SparsePoseAdjustment::optimize(PoseGraph& graph) {
  const auto start = std::chrono::steady_clock::now();
  PoseAdjustmentReport report;
  report.converged = graph.num_nodes() == 0;
  if (report.converged) return report;

  begin(graph);
  report.structure_reused = !equations_.restructured();
  report.initial_chi2 = current_.sum;
  report.initial_robust_chi2 = current_.robust_sum;
  while (!report.converged && report.iterations < options_.max_iterations && lambda_ <= kMaxLambda) {
    if (!linearized_) linearize(graph, report);
    report.converged = judge(attempt_step(graph), report);
    ++report.iterations;
  }
  if (uphill_steps_ > 0) std::swap(current_, best_);

  for (std::size_t node = 0; node < current_.poses.size(); ++node) {
    const RotatedPose& pose = current_.poses[node];
    graph.set_pose(node, {pose.x, pose.y, pose.theta});
  }
  report.final_chi2 = current_.sum;
  report.final_robust_chi2 = current_.robust_sum;
  report.fits.reserve(graph.num_constraints());
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    const double weight =
        graph.enabled(i) ? kernel_of(graph.constraints()[i], options_).weight(current_.chi2[i]) : 0;
    report.fits.push_back({current_.chi2[i], weight});
  }
  report.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace psi_slam
