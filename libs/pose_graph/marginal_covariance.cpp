// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/marginal_covariance.h"

#include "pose_graph/constraint_error.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Columns = BlockCholesky::InverseColumns;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Returns the block of H^-1 for two variables, Y_a^T Y_b. Both lists of rows ascend and end with the same
// row.
Eigen::Matrix3d product(const Columns& a, const Columns& b) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = a.rows.size(), j = b.rows.size(); i > 0 && j > 0;) {
    if (a.rows[i - 1] == b.rows[j - 1]) {
      --i;
      --j;
      sum.noalias() += a.blocks[i].transpose() * b.blocks[j];
    } else if (a.rows[i - 1] > b.rows[j - 1]) {
      --i;
    } else {
      --j;
    }
  }
  return sum;
}

Matrix6d joint_of(const Columns& a, const Columns& b) {
  Matrix6d joint;
  joint.topLeftCorner<3, 3>() = product(a, a);
  joint.topRightCorner<3, 3>() = product(a, b);
  joint.bottomLeftCorner<3, 3>() = joint.topRightCorner<3, 3>().transpose();
  joint.bottomRightCorner<3, 3>() = product(b, b);
  return joint;
}

}  // namespace

void MarginalCovariance::update(const PoseGraph& graph, const std::vector<double>& weights) {
  equations_.prepare(graph);
  poses_ = rotated(graph.poses());
  // H does not depend on the errors.
  const std::vector<Eigen::Vector3d> errors(graph.num_constraints(), Eigen::Vector3d::Zero());
  const std::vector<double> ones(weights.empty() ? graph.num_constraints() : 0, 1.0);
  equations_.linearize(graph, poses_, errors, weights.empty() ? ones : weights);
  if (!equations_.factorize(0)) {
    poses_.clear();
    throw UserError(
        "the constraints of the pose graph do not determine all poses: their information is singular. Give "
        "each node constraints with information about x, y and the heading.");
  }
}

// Returns the columns of L^-1 for a node; no rows for the root, whose pose is exact.
Columns MarginalCovariance::columns_of(std::size_t node) const {
  static_cast<void>(poses_.at(node));
  const std::uint32_t variable = equations_.variable_of(node);
  return variable == NormalEquations::kHeld ? Columns() : equations_.factor().inverse_columns(variable);
}

Eigen::Matrix3d MarginalCovariance::marginal(std::size_t node) const {
  const Columns columns = columns_of(node);
  return product(columns, columns);
}

std::vector<Eigen::Matrix3d> MarginalCovariance::marginals() const {
  const std::vector<Eigen::Matrix3d> of_variables = equations_.factor().inverse_diagonal_blocks();
  std::vector<Eigen::Matrix3d> covariances;
  covariances.reserve(poses_.size());
  for (std::size_t node = 0; node < poses_.size(); ++node) {
    const std::uint32_t variable = equations_.variable_of(node);
    covariances.push_back(variable == NormalEquations::kHeld ? Eigen::Matrix3d(Eigen::Matrix3d::Zero())
                                                             : of_variables[variable]);
  }
  return covariances;
}

std::vector<Eigen::Vector3d> MarginalCovariance::covariances_with_sum(
    const std::vector<Eigen::Vector3d>& weights) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(3 * (static_cast<Eigen::Index>(poses_.size()) - 1));
  const auto of_variable = [&](std::size_t node) {
    return 3 * static_cast<Eigen::Index>(equations_.variable_of(node));
  };
  const auto is_held = [&](std::size_t node) {
    return equations_.variable_of(node) == NormalEquations::kHeld;
  };
  for (std::size_t node = 0; node < poses_.size(); ++node)
    if (!is_held(node)) sums.segment<3>(of_variable(node)) = weights.at(node);
  equations_.factor().solve(sums);
  std::vector<Eigen::Vector3d> covariances(poses_.size(), Eigen::Vector3d::Zero());
  for (std::size_t node = 0; node < poses_.size(); ++node)
    if (!is_held(node)) covariances[node] = sums.segment<3>(of_variable(node));
  return covariances;
}

Matrix6d MarginalCovariance::joint(std::size_t a, std::size_t b) const {
  return joint_of(columns_of(a), columns_of(b));
}

std::vector<Eigen::Matrix3d> MarginalCovariance::relative(std::size_t a,
                                                          const std::vector<std::size_t>& others) const {
  const Columns columns = columns_of(a);
  std::vector<Eigen::Matrix3d> result;
  result.reserve(others.size());
  for (const std::size_t b : others) {
    const ConstraintJacobians jacobians = constraint_jacobians(poses_[a], poses_.at(b));
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << jacobians.wrt_i, jacobians.wrt_j;
    const Matrix6d joint = joint_of(columns, columns_of(b));
    result.push_back(jacobian * joint * jacobian.transpose());
  }
  return result;
}

}  // namespace psi_slam
