// SPDX-License-Identifier: BSD-3-Clause
// Uncertainty of the poses of a graph, given all its constraints: blocks of the inverse of H = J^T Omega J at
// the current poses. Computes H^-1 = L^-T L^-1 only from the columns of L^-1 that a block needs (Kaess and
// Dellaert, "Covariance recovery from a square root information matrix for data association", RAS 2009).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "pose_graph/normal_equations.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Computes covariances of (x, y, theta): m^2, m rad, rad^2. Keep the object between calls, because it reuses
/// the order of elimination and the memory layout of a growing graph.
class MarginalCovariance {
 public:
  /// Factorises H of the graph at its current poses. Call before the other functions. `weights` multiply the
  /// information matrices (ConstraintFit::weight); if empty, all weights are 1. Throws UserError if a node is
  /// not linked to the root, or if the constraints do not determine all poses.
  void update(const PoseGraph& graph, const std::vector<double>& weights = {});

  /// 3x3 covariance of the pose of a node, in the axes of the map. Zero for the root.
  Eigen::Matrix3d marginal(std::size_t node) const;

  /// Returns marginal(node) for all nodes, in about the time of update().
  std::vector<Eigen::Matrix3d> marginals() const;

  /// Returns the covariance of (x, y, theta) of each node with the sum of weights[i] . (x, y, theta) over all
  /// nodes i, in the axes of the map. Zero for the root. `weights` has one entry per node.
  std::vector<Eigen::Vector3d> covariances_with_sum(const std::vector<Eigen::Vector3d>& weights) const;

  /// 6x6 covariance of the poses of nodes a and b, in the axes of the map.
  Eigen::Matrix<double, 6, 6> joint(std::size_t a, std::size_t b) const;

  /// 3x3 covariance of the pose of b relative to a, in the axes of a.
  Eigen::Matrix3d relative(std::size_t a, std::size_t b) const { return relative(a, std::vector{b}).front(); }

  /// Returns relative(a, b) for each b of `others`, at less than half the work per node.
  std::vector<Eigen::Matrix3d> relative(std::size_t a, const std::vector<std::size_t>& others) const;

 private:
  BlockCholesky::InverseColumns columns_of(std::size_t node) const;

  NormalEquations equations_;
  std::vector<RotatedPose> poses_;
};

}  // namespace psi_slam
