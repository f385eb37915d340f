// SPDX-License-Identifier: BSD-3-Clause
// How uncertain the poses of a graph are, given all its constraints: blocks of the inverse of H = J^T Omega J
// at the current poses, H^-1 = L^-T L^-1 by the columns of L^-1 that a block needs (Kaess and Dellaert,
// "Covariance recovery from a square root information matrix for data association", RAS 2009).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "pose_graph/normal_equations.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Covariances of (x, y, theta): m^2, m rad, rad^2. Keep the object between calls: as the solver, it keeps
/// the order and the layout of a graph that grows.
class MarginalCovariance {
 public:
  /// Factorises the graph's H at its current poses; the questions below are about that state. `weights`
  /// multiply the information matrices (ConstraintFit::weight); empty means 1 each. Throws UserError when a
  /// node is not linked to the root, or the constraints leave a pose undetermined.
  void update(const PoseGraph& graph, const std::vector<double>& weights = {});

  /// Of a node's pose, in the axes of the map; the root's is zero. 3x3.
  Eigen::Matrix3d marginal(std::size_t node) const;

  /// Of the poses of two nodes, first a, then b, in the axes of the map. 6x6.
  Eigen::Matrix<double, 6, 6> joint(std::size_t a, std::size_t b) const;

  /// Of the pose of b in the axes of a. 3x3.
  Eigen::Matrix3d relative(std::size_t a, std::size_t b) const { return relative(a, std::vector{b}).front(); }

  /// The same for many b, which is less than half the work.
  std::vector<Eigen::Matrix3d> relative(std::size_t a, const std::vector<std::size_t>& others) const;

 private:
  BlockCholesky::InverseColumns columns_of(std::size_t node) const;

  NormalEquations equations_;
  std::vector<RotatedPose> poses_;
};

}  // namespace psi_slam
