// SPDX-License-Identifier: BSD-3-Clause
// The normal equations H dx = -g of a pose graph (equation 6, with H = J^T Omega J and g = J^T Omega e) and
// their sparse factorisation. They are made to be kept between the solves of a growing graph: each constraint
// knows its place in H, and the order of elimination is kept and extended at its end until it has aged.
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
  /// Which of a pose's coordinates may move. Headings alone see the heading parts of the constraints only.
  enum class Coordinates { kAll, kHeadings, kPositions };

  /// Makes room for every node but the root, which is held, and for every enabled constraint. What is known
  /// from earlier calls is used again as far as the graph still is the same or has grown; any other graph is
  /// taken in as new. Throws UserError when no chain of enabled constraints leads from the root to some node.
  void prepare(const PoseGraph& graph);

  /// H and g at `poses`. `errors` and `weights` have an entry for each constraint of the graph; a weight
  /// multiplies the information matrix.
  void linearize(const PoseGraph& graph, const std::vector<RotatedPose>& poses,
                 const std::vector<Eigen::Vector3d>& errors, const std::vector<double>& weights,
                 Coordinates coordinates = Coordinates::kAll);

  /// Factorises H + lambda diag(H); false when that is not positive definite.
  bool factorize(double lambda);

  /// dx of (H + lambda diag(H)) dx = -g, three numbers a variable. Needs factorize().
  Eigen::VectorXd step() const;

  /// By how much the linearised error sum E falls with that step: -2 g^T dx - dx^T H dx.
  double predicted_decrease(const Eigen::VectorXd& step, double lambda) const;

  /// The largest entry of the gradient of E in absolute value, 2 |g|.
  double max_gradient() const { return gradient_.size() == 0 ? 0 : 2 * gradient_.cwiseAbs().maxCoeff(); }

  static constexpr std::uint32_t kHeld = 0xffffffff;
  /// The number of a node's variable, in the order of elimination; kHeld for the root.
  std::uint32_t variable_of(std::size_t node) const { return variable_of_[node]; }

  const BlockCholesky& factor() const { return factor_; }
  const SymmetricBlockMatrix& hessian() const { return hessian_; }

  /// True when the last prepare() found a new order of elimination, or had to lay out H anew.
  bool reordered() const { return reordered_; }
  bool restructured() const { return restructured_; }

 private:
  struct Place {
    std::uint32_t block = 0;  // of hessian_.blocks; kNoBlock when an end is held
    bool known = false;
    bool transposed = false;  // the block of H is (to, from)
  };
  static constexpr std::uint32_t kNoBlock = 0xffffffff;

  bool continues(const PoseGraph& graph) const;
  void check_connected(const PoseGraph& graph);
  void find_order(const PoseGraph& graph);
  void lay_out(const PoseGraph& graph);
  void hold(int coordinate);

  std::size_t root_ = 0;
  std::vector<std::uint32_t> node_of_;                         // by variable
  std::vector<std::uint32_t> variable_of_;                     // by node
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends_;  // of the constraints taken in so far
  std::vector<Place> places_;                                  // beside ends_
  std::size_t ordered_variables_ = 0;                          // when the order was found
  double ordered_products_ = 0;                                // of a factorisation then
  double wasted_products_ = 0;  // since then, over what the order would have taken had it stayed as good
  bool reordered_ = false;
  bool restructured_ = false;

  SymmetricBlockMatrix hessian_;
  Eigen::VectorXd gradient_;  // g
  BlockCholesky factor_;
  std::vector<std::uint32_t> component_;  // scratch
};

}  // namespace psi_slam
