// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/pose_graph.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/portable_math.h"
#include "pose_graph/constraint_error.h"
#include "pose_graph/information_matrix.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

bool is_finite(const TPose2D& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.phi);
}

TPose2D checked(const TPose2D& pose) {
  if (!is_finite(pose)) throw std::invalid_argument("PoseGraph: the pose of a node is not finite");
  return {pose.x, pose.y, wrap_to_pi(pose.phi)};
}

PoseCovariance packed(const Eigen::Matrix3d& covariance) {
  return {covariance(0, 0), covariance(0, 1), covariance(0, 2),
          covariance(1, 1), covariance(1, 2), covariance(2, 2)};
}

GraphLink link_of(const Constraint& constraint) {
  GraphLink link;
  link.from = static_cast<std::uint32_t>(constraint.from);
  link.to = static_cast<std::uint32_t>(constraint.to);
  Eigen::Matrix3d covariance;
  bool invertible = false;
  // Scales the matrix to a unit diagonal, so that the units do not decide whether it counts as singular.
  const Eigen::Vector3d scale = constraint.information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d scaled = scale.asDiagonal() * constraint.information * scale.asDiagonal();
  constexpr double kSingular = 1e-12;
  if (scale.allFinite()) scaled.computeInverseWithCheck(covariance, invertible, kSingular);
  if (invertible) {
    covariance = (scale.asDiagonal() * covariance * scale.asDiagonal()).eval();
  } else {
    covariance = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()).asDiagonal();
  }
  link.covariance = packed(covariance);
  link.doubt = packed(constraint.doubt);
  return link;
}

}  // namespace

double RobustKernel::cost(double chi2) const {
  const double width2 = width * width;
  switch (type) {
    case Type::kNone:
      return chi2;
    case Type::kHuber:
      return chi2 <= width2 ? chi2 : 2 * width * std::sqrt(chi2) - width2;
    case Type::kCauchy:
      return width2 * portable::log1p(chi2 / width2);
    case Type::kDynamicScaling:
      return chi2 <= width2 ? chi2 : width2 * (3 * chi2 - width2) / (chi2 + width2);
    case Type::kGemanMcClure:
      return width2 * chi2 / (width2 + chi2);
  }
  return chi2;
}

double RobustKernel::weight(double chi2) const {
  const double width2 = width * width;
  switch (type) {
    case Type::kNone:
      return 1;
    case Type::kHuber:
      return chi2 <= width2 ? 1 : width / std::sqrt(chi2);
    case Type::kCauchy:
      return 1 / (1 + chi2 / width2);
    case Type::kDynamicScaling: {
      const double scale = chi2 <= width2 ? 1 : 2 * width2 / (width2 + chi2);
      return scale * scale;
    }
    case Type::kGemanMcClure: {
      const double scale = width2 / (width2 + chi2);
      return scale * scale;
    }
  }
  return 1;
}

std::size_t PoseGraph::add_node(const TPose2D& map_T_node) {
  poses_.push_back(checked(map_T_node));
  incident_.emplace_back();
  return poses_.size() - 1;
}

std::size_t PoseGraph::add_constraint(const Constraint& constraint) {
  if (constraint.from >= poses_.size() || constraint.to >= poses_.size())
    throw std::out_of_range("PoseGraph: a constraint names a node that does not exist");
  if (constraint.from == constraint.to) {
    throw std::invalid_argument("PoseGraph: a constraint links node " + std::to_string(constraint.from) +
                                " to itself");
  }
  if (!is_finite(constraint.from_T_to) || !is_information_matrix(constraint.information)) {
    throw std::invalid_argument("PoseGraph: the constraint " + std::to_string(constraint.from) + " -> " +
                                std::to_string(constraint.to) +
                                " is not finite or its information is not positive semi-definite");
  }
  const auto index = static_cast<std::uint32_t>(constraints_.size());
  constraints_.push_back(constraint);
  constraints_.back().from_T_to.phi = wrap_to_pi(constraint.from_T_to.phi);
  links_.push_back(link_of(constraint));
  enabled_.push_back(1);
  incident_[constraint.from].push_back(index);
  incident_[constraint.to].push_back(index);
  return index;
}

void PoseGraph::set_root(std::size_t node) {
  if (node >= poses_.size()) throw std::out_of_range("PoseGraph: the root must be one of the nodes");
  root_ = node;
}

void PoseGraph::set_pose(std::size_t node, const TPose2D& map_T_node) {
  poses_.at(node) = checked(map_T_node);
}

std::size_t PoseGraph::num_enabled_constraints() const {
  return static_cast<std::size_t>(std::count(enabled_.begin(), enabled_.end(), char{1}));
}

double PoseGraph::chi2() const {
  const std::vector<RotatedPose> poses = rotated(poses_);
  double sum = 0;
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    if (enabled_[i] == 0) continue;
    const Constraint& constraint = constraints_[i];
    const Eigen::Vector3d error =
        constraint_error(constraint.from_T_to, poses[constraint.from], poses[constraint.to]);
    sum += error.dot(constraint.information * error);
  }
  return sum;
}

}  // namespace psi_slam
