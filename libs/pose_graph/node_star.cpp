// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/node_star.h"

#include <algorithm>
#include <cmath>

#include "pose_graph/block_cholesky.h"

namespace psi_slam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A constraint is linearised again if the second-order terms of its error exceed this many standard
// deviations, or if its weight has changed by more than this.
constexpr double kMaxSecondOrder = 0.002;
constexpr double kMaxWeightChange = 0.02;

Vector3d vector_of(const RotatedPose& pose) {
  return {pose.x, pose.y, pose.theta};
}

Vector3d step_from(const Vector3d& at, const RotatedPose& pose) {
  return {pose.x - at.x(), pose.y - at.y(), wrap_to_pi(pose.theta - at.z())};
}

// Bound of the second-order terms of a position R(theta)^T d after steps of theta and d, in metres.
double second_order_m(const Vector3d& from_at, const RotatedPose& from, const Vector3d& to_at,
                      const RotatedPose& to) {
  const double turn = std::abs(wrap_to_pi(from.theta - from_at.z()));
  const Eigen::Vector2d apart = to_at.head<2>() - from_at.head<2>();
  const Eigen::Vector2d change = Eigen::Vector2d(to.x - from.x, to.y - from.y) - apart;
  return turn * (change.norm() + turn / 2 * apart.norm());
}

}  // namespace

void NodeStar::add(const PoseGraph& graph, std::uint32_t index) {
  const Constraint& constraint = graph.constraint(index);
  const bool leads_here = constraint.to == centre_;
  End end;
  end.constraint = index;
  end.node = static_cast<std::uint32_t>(leads_here ? constraint.from : constraint.to);
  ends_.push_back(end);
  begins_constraint_ = begins_constraint_ || !leads_here;
}

// Terms of a constraint at the poses where it is linearised.
ConstraintNormals NodeStar::normals(const End& end, const Constraint& constraint) const {
  const auto rotated = [](const Vector3d& at) { return RotatedPose({at.x(), at.y(), at.z()}); };
  const bool leads_here = constraint.to == centre_;
  const RotatedPose from = rotated(leads_here ? end.at : at_);
  const RotatedPose to = rotated(leads_here ? at_ : end.at);
  return constraint_normals(end.weight * constraint.information,
                            constraint_error(constraint.from_T_to, from, to), from, to);
}

bool NodeStar::linearize(const PoseGraph& graph, const std::vector<RotatedPose>& poses,
                         const PoseAdjustmentOptions& options, bool eliminate) {
  at_ = vector_of(poses[centre_]);
  diagonal_.setZero();
  reduced_gradient_.setZero();
  for (End& end : ends_) {
    const Constraint& constraint = graph.constraints()[end.constraint];
    const Vector3d error =
        constraint_error(constraint.from_T_to, poses[constraint.from], poses[constraint.to]);
    const double chi2 = std::max(0.0, error.dot(constraint.information * error));
    end.weight = kernel_of(constraint, options).weight(chi2);
    end.at = vector_of(poses[end.node]);
    const ConstraintNormals terms = normals(end, constraint);
    const bool leads_here = constraint.to == centre_;
    if (leads_here)
      end.cross = terms.ij.transpose();
    else
      end.cross = terms.ij;
    diagonal_ += leads_here ? terms.jj : terms.ii;
    reduced_gradient_ += leads_here ? terms.j : terms.i;
  }
  eliminated_ = eliminate;
  if (!eliminate) return true;
  const Matrix3d block = diagonal_;
  if (!invert_cholesky_factor(block, block.diagonal(), diagonal_)) return false;
  reduced_gradient_ = (diagonal_ * reduced_gradient_).eval();
  for (End& end : ends_) end.cross = (diagonal_ * end.cross).eval();
  return true;
}

void NodeStar::link(const std::vector<std::uint32_t>& variable_of, CondensedEquations& equations) const {
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const std::uint32_t a = variable_of[ends_[i].node];
    if (a == kNoVariable) continue;
    if (!eliminated_) equations.add_link(a, variable_of[centre_]);
    for (std::size_t j = 0; eliminated_ && j < i; ++j)
      if (variable_of[ends_[j].node] != kNoVariable) equations.add_link(a, variable_of[ends_[j].node]);
  }
}

// Entry of the centre of the linearised gradient at `poses` of the ends, with an eliminated centre at at_; if
// the centre is eliminated, L^-1 times it.
Vector3d NodeStar::reduced_gradient(const std::vector<RotatedPose>& poses) const {
  Vector3d gradient = reduced_gradient_;
  for (const End& end : ends_) gradient.noalias() += end.cross * step_from(end.at, poses[end.node]);
  return gradient;
}

void NodeStar::add_to(CondensedEquations& equations, double sign, const PoseGraph& graph,
                      const std::vector<RotatedPose>& poses,
                      const std::vector<std::uint32_t>& variable_of) const {
  const Vector3d of_centre = reduced_gradient(poses);
  const Vector3d centre_step = step_from(at_, poses[centre_]);
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const End& end = ends_[i];
    const std::uint32_t a = variable_of[end.node];
    if (a == kNoVariable) continue;
    const Constraint& constraint = graph.constraints()[end.constraint];
    const ConstraintNormals terms = normals(end, constraint);
    const bool leads_here = constraint.to == centre_;
    const Matrix3d& own = leads_here ? terms.ii : terms.jj;  // block (node, node) of H
    Vector3d gradient = (leads_here ? terms.i : terms.j) + own * step_from(end.at, poses[end.node]);
    if (!eliminated_) {
      gradient.noalias() += end.cross.transpose() * centre_step;
      equations.add(a, sign * own, sign * gradient);
      equations.add(variable_of[centre_], a, sign * end.cross);
      continue;
    }
    gradient.noalias() -= end.cross.transpose() * of_centre;
    equations.add(a, sign * (own - end.cross.transpose() * end.cross), sign * gradient);
    for (std::size_t j = 0; j < i; ++j) {
      const std::uint32_t b = variable_of[ends_[j].node];
      if (b != kNoVariable) equations.add(b, a, -sign * (ends_[j].cross.transpose() * end.cross));
    }
  }
  if (!eliminated_)
    equations.add(variable_of[centre_], sign * diagonal_, sign * (of_centre + diagonal_ * centre_step));
}

RotatedPose NodeStar::centre_pose(const std::vector<RotatedPose>& poses) const {
  const Vector3d pose = at_ - diagonal_.transpose() * reduced_gradient(poses);
  if (begins_constraint_) return RotatedPose({pose.x(), pose.y(), wrap_to_pi(pose.z())});
  RotatedPose unrotated;
  unrotated.x = pose.x();
  unrotated.y = pose.y();
  unrotated.theta = wrap_to_pi(pose.z());
  return unrotated;
}

NodeStar::Fit NodeStar::fit(const PoseGraph& graph, const std::vector<RotatedPose>& poses,
                            const PoseAdjustmentOptions& options) const {
  Fit fit;
  for (const End& end : ends_) {
    const Constraint& constraint = graph.constraints()[end.constraint];
    const RotatedPose& from = poses[constraint.from];
    const RotatedPose& to = poses[constraint.to];
    const Vector3d error = constraint_error(constraint.from_T_to, from, to);
    const double chi2 = std::max(0.0, error.dot(constraint.information * error));
    const RobustKernel& kernel = kernel_of(constraint, options);
    fit.cost += kernel.cost(chi2);
    const bool leads_here = constraint.to == centre_;
    const double second_m = second_order_m(leads_here ? end.at : at_, from, leads_here ? at_ : end.at, to);
    const double per_m2 = end.weight * (constraint.information(0, 0) + constraint.information(1, 1));
    fit.is_linear = fit.is_linear && second_m * second_m * per_m2 <= kMaxSecondOrder * kMaxSecondOrder &&
                    std::abs(kernel.weight(chi2) - end.weight) <= kMaxWeightChange;
  }
  return fit;
}

}  // namespace psi_slam
