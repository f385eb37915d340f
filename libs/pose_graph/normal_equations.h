// SPDX-License-Identifier: BSD-3-Clause
// The normal equations H dx = -g of a pose graph (equation 6, with H = J^T Omega J and g = J^T Omega e) and
// their sparse factorisation. Keep the object between the solves of a growing graph. It stores the place of
// each constraint in H, and extends the order of elimination until a new order is worth its cost.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pose_graph/block_cholesky.h"
#include "pose_graph/constraint_error.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

class NormalEquations {
 public:
  /// Coordinates of the poses that may move. kHeadings uses only the heading parts of the constraints.
  enum class Coordinates { kAll, kHeadings, kPositions };

  /// Prepares H for all nodes except the root, whose pose is held, and for the enabled constraints. Reuses
  /// the results of earlier calls if the graph is the same or has grown. Throws unreachable_node(), a
  /// UserError, if a node is not linked to the root.
  void prepare(const PoseGraph& graph);

  /// Computes H and g at `poses`. `errors` and `weights` have one entry per constraint of the graph; each
  /// weight multiplies the information matrix of its constraint.
  void linearize(const PoseGraph& graph, const std::vector<RotatedPose>& poses,
                 const std::vector<Eigen::Vector3d>& errors, const std::vector<double>& weights,
                 Coordinates coordinates = Coordinates::kAll);

  /// Factorises H + lambda diag(H). Returns false if this matrix is not positive definite.
  bool factorize(double lambda);

  /// Solves (H + lambda diag(H)) dx = -g after factorize(); dx has three numbers per variable.
  Eigen::VectorXd step() const;

  /// Decrease of the linearised error sum E by a step: -2 g^T dx - dx^T H dx.
  double predicted_decrease(const Eigen::VectorXd& step, double lambda) const;

  /// Largest absolute entry of the gradient of E, 2 |g|.
  double max_gradient() const { return gradient_.size() == 0 ? 0 : 2 * gradient_.cwiseAbs().maxCoeff(); }

  static constexpr std::uint32_t kHeld = 0xffffffff;
  /// Number of the variable of a node, in the order of elimination; kHeld for the root.
  std::uint32_t variable_of(std::size_t node) const { return variable_of_[node]; }

  const BlockCholesky& factor() const { return factor_; }
  const SymmetricBlockMatrix& hessian() const { return hessian_; }

  /// Whether the last prepare() computed a new order of elimination.
  bool reordered() const { return reordered_; }
  /// Whether the last prepare() computed a new memory layout of H.
  bool restructured() const { return restructured_; }

 private:
  struct Place {
    std::uint32_t block = 0;  // index in hessian_.blocks; kNoBlock if a node of the constraint is held
    bool known = false;
    bool transposed = false;  // H stores the block (to, from) of the constraint
  };
  static constexpr std::uint32_t kNoBlock = 0xffffffff;

  bool continues(const PoseGraph& graph) const;
  void check_connected(const PoseGraph& graph);
  void find_order(const PoseGraph& graph);
  void lay_out(const PoseGraph& graph);
  void hold(int coordinate);

  std::size_t root_ = 0;
  std::vector<std::uint32_t> node_of_;                         // node of each variable
  std::vector<std::uint32_t> variable_of_;                     // variable of each node
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends_;  // nodes of the constraints added so far
  std::vector<Place> places_;                                  // parallel to ends_
  std::size_t ordered_variables_ = 0;  // number of variables when the order was last computed
  double ordered_products_ = 0;        // block products of a factorisation in that order
  double wasted_products_ = 0;         // block products since then beyond those of an equally good order
  bool reordered_ = false;
  bool restructured_ = false;

  SymmetricBlockMatrix hessian_;
  Eigen::VectorXd gradient_;  // g of the normal equations
  BlockCholesky factor_;
  std::vector<std::uint32_t> component_;  // scratch of check_connected(): a parent of each node
};

}  // namespace psi_slam
