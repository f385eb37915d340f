// SPDX-License-Identifier: BSD-3-Clause
// Sparse Cholesky factorisation A = L L^T of a symmetric positive definite matrix of 3x3 blocks: the
// up-looking algorithm (Davis, Direct Methods for Sparse Linear Systems, 2006, section 4.7) with a block
// where that has a number. The blocks of a pose graph are dense, so that one index, one path in the
// elimination tree and one look-up serve nine numbers: about three times as fast as Eigen's simplicial one in
// the same order, which the tests compare it with.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace psi_slam {

/// The upper triangle of a symmetric block matrix, by columns. All blocks are stored column by column.
struct SymmetricBlockMatrix {
  std::vector<std::size_t>
      column_begin;                 ///< n + 1: the blocks (row, k), row < k, are [column_begin[k], [k + 1])
  std::vector<std::uint32_t> rows;  ///< ascending within a column
  std::vector<Eigen::Matrix3d> blocks;    ///< beside `rows`
  std::vector<Eigen::Matrix3d> diagonal;  ///< n; symmetric

  std::size_t size() const { return diagonal.size(); }
};

class BlockCholesky {
 public:
  /// The symbolic factorisation: everything that depends on `column_begin` and `rows` alone.
  void analyze(const SymmetricBlockMatrix& matrix);

  /// The numeric factorisation of A + D, where D is lambda times the diagonal of A (Levenberg-Marquardt, as
  /// scaled by Marquardt 1963). The matrix must have the structure that was analyzed. False when A + D is not
  /// positive definite; then there is no factor.
  bool factorize(const SymmetricBlockMatrix& matrix, double lambda = 0);

  /// Solves (A + D) x = b in place; b holds 3 numbers a block row.
  void solve(Eigen::VectorXd& b) const;

  /// Non-zero blocks of columns of L^-1, for marginal covariances: L Y = [the three unit columns of block row
  /// k]. They lie on the path from k to the root of the elimination tree.
  struct InverseColumns {
    std::vector<std::uint32_t> rows;      ///< ascending
    std::vector<Eigen::Matrix3d> blocks;  ///< beside `rows`
  };
  InverseColumns inverse_columns(std::size_t k) const;

  std::size_t size() const { return parent_.size(); }
  /// Products of two blocks that a factorisation takes: its work, and so the measure of an order's quality.
  std::size_t num_products() const { return num_products_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::size_t reach(const SymmetricBlockMatrix& matrix, std::uint32_t k);

  std::size_t num_products_ = 0;
  std::vector<std::uint32_t> parent_;      // elimination tree
  std::vector<std::size_t> column_begin_;  // of L, n + 1
  std::vector<std::size_t> column_end_;    // while factorising: where the next block of each column goes
  std::vector<std::uint32_t> rows_;
  std::vector<Eigen::Matrix3d> blocks_;
  std::vector<Eigen::Matrix3d> inverse_diagonal_;  // inverse of the diagonal blocks of L, lower triangular

  std::vector<std::uint32_t> mark_;     // scratch: mark_[i] == k when i was reached for row k
  std::vector<std::uint32_t> pattern_;  // scratch: the columns of row k of L, in topological order
  std::vector<std::uint32_t> path_;     // scratch
  std::vector<Eigen::Matrix3d> work_;   // scratch: zero between rows
};

}  // namespace psi_slam
