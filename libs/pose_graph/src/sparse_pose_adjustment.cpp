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

void SparsePoseAdjustment::apply(const Eigen::VectorXd& step, const State& from, State& to) const {
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
  weights_.resize(graph.num_constraints());
  const auto reweight = [&] {
    for (std::size_t i = 0; i < weights_.size(); ++i)
      weights_[i] = graph.enabled(i) ? kernel_of(graph.constraints()[i]).weight(current_.chi2[i]) : 0;
  };

  double lambda = options_.initial_lambda;
  bool stuck = false;
  while (report.iterations < options_.max_iterations && !report.converged && !stuck) {
    ++report.iterations;
    reweight();
    equations_.linearize(graph, current_.poses, current_.errors, weights_);
    report.max_gradient = equations_.max_gradient();
    const double negligible = options_.absolute_tolerance + options_.relative_tolerance * current_.robust_sum;
    for (bool accepted = false; !accepted && !report.converged && !stuck;) {
      bool lowered = false;
      if (equations_.factorize(lambda)) {
        const Eigen::VectorXd step = equations_.step();
        apply(step, current_, trial_);
        evaluate(graph, trial_);
        lowered = trial_.robust_sum <= current_.robust_sum;  // false for NaN too
        // Damping shortens the step: a small decrease says something about E only where lambda is small.
        const double decrease =
            lowered ? current_.robust_sum - trial_.robust_sum : equations_.predicted_decrease(step, lambda);
        report.converged = lambda < 1 && decrease <= negligible;
      }
      if (lowered) {
        std::swap(current_, trial_);
        accepted = true;
        lambda = lambda * kLambdaDown < kMinLambda ? 0 : lambda * kLambdaDown;
      } else if (!report.converged) {
        ++report.rejected_steps;
        lambda = std::max(kFirstLambda, lambda * kLambdaUp);
        stuck = lambda > kMaxLambda;
      }
    }
  }

  reweight();
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
