// SPDX-License-Identifier: BSD-3-Clause
// Slow and simple implementations that the tests compare with the library. They share only the class
// PoseGraph and wrap_to_pi() with it.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <vector>

#include "test_graphs.h"

namespace psi_slam {

/// Error of a constraint by the definition in equation 6.
inline Eigen::Vector3d reference_error(const Constraint& constraint, const TPose2D& from, const TPose2D& to) {
  const TPose2D predicted = relative_pose(from, to);
  return {constraint.from_T_to.x - predicted.x, constraint.from_T_to.y - predicted.y,
          wrap_to_pi(constraint.from_T_to.phi - predicted.phi)};
}

/// 3x6 Jacobian by central differences, with respect to the pose of `from`, then of `to`.
inline Eigen::Matrix<double, 3, 6> numeric_jacobian(const Constraint& constraint, const TPose2D& from,
                                                    const TPose2D& to) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, 3, 6> jacobian;
  for (int k = 0; k < 6; ++k) {
    TPose2D ends[2][2] = {{from, to}, {from, to}};
    ends[0][k / 3][static_cast<std::size_t>(k % 3)] += kStep;
    ends[1][k / 3][static_cast<std::size_t>(k % 3)] -= kStep;
    jacobian.col(k) = (reference_error(constraint, ends[0][0], ends[0][1]) -
                       reference_error(constraint, ends[1][0], ends[1][1])) /
                      (2 * kStep);
  }
  return jacobian;
}

/// H = J^T Omega J and g = J^T Omega e of all nodes including the root, with 3 rows per node. Computed with
/// numeric Jacobians.
struct DenseSystem {
  Eigen::MatrixXd h;
  Eigen::VectorXd g;
};

inline DenseSystem dense_system(const PoseGraph& graph) {
  const auto size = 3 * static_cast<Eigen::Index>(graph.num_nodes());
  DenseSystem system{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    if (!graph.enabled(i)) continue;
    const Constraint& constraint = graph.constraint(i);
    const TPose2D& from = graph.pose(constraint.from);
    const TPose2D& to = graph.pose(constraint.to);
    const Eigen::Matrix<double, 3, 6> jacobian = numeric_jacobian(constraint, from, to);
    const Eigen::Matrix<double, 6, 3> weighted = jacobian.transpose() * constraint.information;
    const Eigen::Matrix<double, 6, 6> h = weighted * jacobian;
    const Eigen::Matrix<double, 6, 1> g = weighted * reference_error(constraint, from, to);
    const Eigen::Index rows[2] = {3 * static_cast<Eigen::Index>(constraint.from),
                                  3 * static_cast<Eigen::Index>(constraint.to)};
    for (int a = 0; a < 2; ++a) {
      system.g.segment<3>(rows[a]) += g.segment<3>(3 * a);
      for (int b = 0; b < 2; ++b) system.h.block<3, 3>(rows[a], rows[b]) += h.block<3, 3>(3 * a, 3 * b);
    }
  }
  return system;
}

/// The dense system without the rows and columns of the root, which must be node 0.
inline DenseSystem held_at_root(const DenseSystem& system) {
  const Eigen::Index size = system.g.size() - 3;
  return {system.h.bottomRightCorner(size, size), system.g.tail(size)};
}

/// Adds a step of 3 numbers per node to the poses of all nodes but node 0.
inline void move_all(PoseGraph& graph, const Eigen::VectorXd& step) {
  for (std::size_t node = 1; node < graph.num_nodes(); ++node) {
    const TPose2D& pose = graph.pose(node);
    const Eigen::Vector3d delta = step.segment<3>(3 * static_cast<Eigen::Index>(node) - 3);
    graph.set_pose(node, {pose.x + delta.x(), pose.y + delta.y(), pose.phi + delta.z()});
  }
}

/// Undamped Gauss-Newton with dense algebra; the root must be node 0.
inline void dense_gauss_newton(PoseGraph& graph, int iterations) {
  for (int i = 0; i < iterations; ++i) {
    const DenseSystem system = held_at_root(dense_system(graph));
    move_all(graph, system.h.ldlt().solve(-system.g));
  }
}

/// Undamped Gauss-Newton for large graphs, with Eigen's sparse factorisation. Returns the Newton decrement
/// g^T H^-1 g of the last step: the remaining decrease of the linearised error sum.
inline double sparse_gauss_newton(PoseGraph& graph, int iterations) {
  double decrement = 0;
  for (int i = 0; i < iterations; ++i) {
    const auto size = 3 * static_cast<Eigen::Index>(graph.num_nodes()) - 3;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd g = Eigen::VectorXd::Zero(size);
    for (std::size_t c = 0; c < graph.num_constraints(); ++c) {
      const Constraint& constraint = graph.constraint(c);
      const TPose2D& from = graph.pose(constraint.from);
      const TPose2D& to = graph.pose(constraint.to);
      const Eigen::Matrix<double, 3, 6> jacobian = numeric_jacobian(constraint, from, to);
      const Eigen::Matrix<double, 6, 3> weighted = jacobian.transpose() * constraint.information;
      const Eigen::Matrix<double, 6, 6> h = weighted * jacobian;
      const Eigen::Matrix<double, 6, 1> b = weighted * reference_error(constraint, from, to);
      const auto row_of = [&](int k) {
        const std::size_t node = k < 3 ? constraint.from : constraint.to;
        return 3 * static_cast<Eigen::Index>(node) - 3 + k % 3;
      };
      for (int r = 0; r < 6; ++r) {
        if (row_of(r) < 0) continue;
        g[row_of(r)] += b[r];
        for (int k = 0; k < 6; ++k)
          if (row_of(k) >= 0)
            entries.emplace_back(static_cast<int>(row_of(r)), static_cast<int>(row_of(k)), h(r, k));
      }
    }
    Eigen::SparseMatrix<double> h(size, size);
    h.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(h);
    const Eigen::VectorXd step = factor.solve(-g);
    decrement = -g.dot(step);
    move_all(graph, step);
  }
  return decrement;
}

}  // namespace psi_slam
