// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/pose_graph/sparse_pose_adjustment.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace psi_slam {
namespace {

// Damping after the first rejected step, and how it changes from then on.
constexpr double kFirstLambda = 1e-5;
constexpr double kLambdaUp = 10;
constexpr double kLambdaDown = 0.1;
constexpr double kMinLambda = 1e-8;  // below it, none
constexpr double kMaxLambda = 1e10;  // beyond it no step is left to try
// A small decrease under stronger damping says nothing about how far the minimum is.
constexpr double kMaxLambdaOfConvergence = 1e-3;

constexpr int kMaxUphillSteps = 2;
// The linearisation is poor where E after a step is this many times what it promised.
constexpr double kPoorPrediction = 10;

}  // namespace

const RobustKernel& SparsePoseAdjustment::kernel_of(const Constraint& constraint) const {
  if (constraint.kernel) return *constraint.kernel;
  switch (constraint.kind) {
    case Constraint::Kind::kOdometry:
      return options_.odometry_kernel;
    case Constraint::Kind::kLocalMap:
      return options_.local_map_kernel;
    case Constraint::Kind::kLoop:
      break;
  }
  return options_.loop_kernel;
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
    state.robust_sum += kernel_of(constraint).cost(state.chi2[i]);
  }
}

void SparsePoseAdjustment::reweight(const PoseGraph& graph) {
  weights_.resize(graph.num_constraints());
  for (std::size_t i = 0; i < weights_.size(); ++i)
    weights_[i] = graph.enabled(i) ? kernel_of(graph.constraints()[i]).weight(current_.chi2[i]) : 0;
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

// From current_ and with its weights. False when a factorisation fails.
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

PoseAdjustmentReport SparsePoseAdjustment::optimize(PoseGraph& graph) {
  const auto start = std::chrono::steady_clock::now();
  PoseAdjustmentReport report;
  if (graph.num_nodes() == 0) {
    report.converged = true;
    return report;
  }
  equations_.prepare(graph);
  report.structure_reused = !equations_.restructured();
  current_.poses.clear();
  for (const mrpt::math::TPose2D& pose : graph.poses()) current_.poses.emplace_back(pose);
  evaluate(graph, current_);
  report.initial_chi2 = current_.sum;
  report.initial_robust_chi2 = current_.robust_sum;

  double lambda = options_.initial_lambda;
  double lowest = current_.robust_sum;
  int uphill = 0;  // steps since current_ left best_
  bool linearized = false;
  bool headings_tried = false;
  while (report.iterations < options_.max_iterations && lambda <= kMaxLambda) {
    ++report.iterations;
    if (!linearized) {
      reweight(graph);
      equations_.linearize(graph, current_.poses, current_.errors, weights_);
      if (uphill == 0) report.max_gradient = equations_.max_gradient();
      linearized = true;
    }
    const bool solved = equations_.factorize(lambda);
    double promised = 0;  // decrease of E
    if (solved) {
      const Eigen::VectorXd step = equations_.step();
      promised = equations_.predicted_decrease(step, lambda);
      move(graph, current_, step, trial_);
    }
    const double negligible = options_.absolute_tolerance + options_.relative_tolerance * lowest;
    const double remaining = std::max(current_.robust_sum - promised, negligible);
    if (!headings_tried && !(solved && trial_.robust_sum <= kPoorPrediction * remaining)) {
      headings_tried = true;
      linearized = false;
      State rival;
      if (solve_headings_first(graph, rival) && !(solved && trial_.robust_sum <= rival.robust_sum)) {
        std::swap(trial_, rival);
        report.headings_first = trial_.robust_sum <= lowest;
      }
    }

    const bool small_damping = lambda <= kMaxLambdaOfConvergence;
    if (trial_.robust_sum <= lowest) {  // false for NaN
      report.converged = solved && small_damping && lowest - trial_.robust_sum <= negligible;
      std::swap(current_, trial_);
      lowest = current_.robust_sum;
      uphill = 0;
      linearized = false;
      lambda = lambda * kLambdaDown < kMinLambda ? 0 : lambda * kLambdaDown;
    } else if (solved && uphill == 0 && small_damping && promised <= negligible) {
      report.converged = true;  // the minimum up to rounding
    } else {
      ++report.rejected_steps;
      if (lambda == 0 && uphill < kMaxUphillSteps && std::isfinite(trial_.robust_sum)) {
        if (uphill == 0) best_ = current_;
        ++uphill;
        std::swap(current_, trial_);
        linearized = false;
      } else {
        if (uphill > 0) {
          std::swap(current_, best_);
          linearized = false;
        }
        uphill = 0;
        lambda = std::max(kFirstLambda, lambda * kLambdaUp);
      }
    }
    if (report.converged) break;
  }
  if (uphill > 0) std::swap(current_, best_);

  reweight(graph);
  for (std::size_t node = 0; node < current_.poses.size(); ++node) {
    const RotatedPose& pose = current_.poses[node];
    graph.set_pose(node, {pose.x, pose.y, pose.theta});
  }
  report.final_chi2 = current_.sum;
  report.final_robust_chi2 = current_.robust_sum;
  report.fits.resize(weights_.size());
  for (std::size_t i = 0; i < weights_.size(); ++i) report.fits[i] = {current_.chi2[i], weights_[i]};
  report.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace psi_slam
