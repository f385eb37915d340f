// SPDX-License-Identifier: BSD-3-Clause
// The normal equations of the nodes that remain after the elimination of all others (Schur complement), for a
// growing graph. Terms are added and subtracted as constraints change; only the sum is stored.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pose_graph/block_cholesky.h"

namespace psi_slam {

class CondensedEquations {
 public:
  /// Adds a variable and returns its number. It is eliminated after all earlier variables until lay_out()
  /// computes a new order of elimination.
  std::uint32_t add_variable();
  /// Makes room for the block of two variables.
  void add_link(std::uint32_t a, std::uint32_t b);
  /// Applies add_variable() and add_link(). Computes a new order of elimination if `reorder` is true, or if
  /// the additions have made the present order too costly.
  void lay_out(bool reorder = false);

  // Both functions require lay_out() after the variables and links were added.

  /// Adds `sum` to the block (a, b) of the matrix, and its transpose to the block (b, a).
  void add(std::uint32_t a, std::uint32_t b, const Eigen::Matrix3d& sum);
  /// Adds the symmetric matrix `sum` to the block (a, a), and `gradient` to entry a of the gradient.
  void add(std::uint32_t a, const Eigen::Matrix3d& sum, const Eigen::Vector3d& gradient);

  /// Solves H dx = -g. The gradient is 0 afterwards, as it is at the poses after this step. Returns false
  /// without a change if H is not positive definite.
  bool solve();
  /// Step of a variable by the last solve(): metres, metres, radians.
  Eigen::Vector3d step(std::uint32_t variable) const { return step_.segment<3>(row(position_[variable])); }
  /// Decrease -g^T dx of the linearised error sum by the last solve().
  double predicted_decrease() const { return predicted_decrease_; }

  std::size_t num_variables() const { return position_.size(); }
  /// Number of block products of a complete factorisation.
  std::size_t num_products() const { return factor_.num_products(); }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  static Eigen::Index row(std::uint32_t position) { return 3 * static_cast<Eigen::Index>(position); }
  std::size_t find(std::uint32_t column, std::uint32_t row) const;
  void insert_news();
  void arrange(const std::vector<std::uint32_t>& new_position);
  void find_order();

  /// Positions of the variables in the order of elimination. The matrix and the vectors use this order.
  std::vector<std::uint32_t> position_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> new_links_;  ///< column and row of new blocks
  SymmetricBlockMatrix hessian_;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd step_;
  double predicted_decrease_ = 0;
  BlockCholesky factor_;
  double products_per_variable_ = 0;  ///< of the order of elimination when it was new
};

}  // namespace psi_slam
