// SPDX-License-Identifier: BSD-3-Clause
// Sparse Cholesky factorisation A = L L^T of a symmetric positive definite matrix of 3x3 blocks, by the
// up-looking algorithm (Davis, Direct Methods for Sparse Linear Systems, 2006, section 4.7). One index and
// one path in the elimination tree serve the nine numbers of a dense block. The factorisation is at least
// three times as fast as Eigen's simplicial factorisation in the same order, with which the tests compare it.
// After changes of some blocks, only the columns that depend on them are computed again.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace psi_slam {

/// The upper triangle of a symmetric block matrix, by columns. All blocks are stored column by column.
struct SymmetricBlockMatrix {
  /// n + 1 entries: the blocks (row, k) with row < k have the indices [column_begin[k], column_begin[k + 1])
  /// in `rows` and `blocks`.
  std::vector<std::size_t> column_begin;
  std::vector<std::uint32_t> rows;        ///< row of each block, ascending within a column
  std::vector<Eigen::Matrix3d> blocks;    ///< blocks above the diagonal, in the order of `rows`
  std::vector<Eigen::Matrix3d> diagonal;  ///< the n blocks on the diagonal, each symmetric

  std::size_t size() const { return diagonal.size(); }
};

/// Returns an order of elimination that keeps the Cholesky factor of a symmetric block matrix sparse:
/// order[k] is the variable eliminated k-th. Approximate minimum degree (Amestoy, Davis, Duff 1996) on the
/// graph of the blocks. `links` are the blocks off the diagonal, each once or more, as (row, column) in
/// either order.
std::vector<std::uint32_t> fill_reducing_order(
    std::size_t num_variables, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& links);

/// Computes the inverse of the Cholesky factor of the symmetric 3x3 matrix `a`. Reads only the lower
/// triangle. Returns false if `a` is not positive definite. A pivot must exceed the rounding error of the
/// original diagonal, from which other terms were subtracted.
bool invert_cholesky_factor(const Eigen::Matrix3d& a, const Eigen::Vector3d& original_diagonal,
                            Eigen::Matrix3d& inverse);

class BlockCholesky {
 public:
  /// Symbolic factorisation: computes everything that depends only on `column_begin` and `rows`.
  void analyze(const SymmetricBlockMatrix& matrix);

  /// Symbolic factorisation of a matrix that extends the last one: block rows were appended, and blocks were
  /// inserted, which touch() must state. Keeps the factor for refactorize().
  void extend(const SymmetricBlockMatrix& matrix);

  /// Numeric factorisation of A + D, where D is lambda times the diagonal of A (the scaling of Marquardt
  /// 1963). The matrix must have the structure passed to analyze(). Returns false, without a factor, if A + D
  /// is not positive definite.
  bool factorize(const SymmetricBlockMatrix& matrix, double lambda = 0);

  /// States that the block (i, k) of the matrix, or (i, i), has changed since the last factorisation; i < k.
  void touch(std::uint32_t i);
  /// Gives the result of factorize(matrix), to the last bit. Computes only the columns of L that depend on
  /// the blocks of touch(): those on the paths from the blocks to the root of the elimination tree.
  bool refactorize(const SymmetricBlockMatrix& matrix);

  /// Solves (A + D) x = b in place; b holds 3 numbers per block row.
  void solve(Eigen::VectorXd& b) const;

  /// Non-zero blocks of the columns of L^-1 for block row k, for marginal covariances. The columns Y solve L
  /// Y = E_k, where E_k holds the three unit columns of row k. The non-zero blocks lie on the path from k to
  /// the root of the elimination tree.
  struct InverseColumns {
    std::vector<std::uint32_t> rows;      ///< row of each block, ascending
    std::vector<Eigen::Matrix3d> blocks;  ///< non-zero blocks, in the order of `rows`
  };
  InverseColumns inverse_columns(std::size_t k) const;

  /// Diagonal blocks of the inverse of A + D, in the order of the block rows. Computes only the blocks of the
  /// inverse where L has blocks (Takahashi, Fagan and Chen, "Formation of a sparse bus impedance matrix and
  /// its application to short circuit study", PICA 1973), in about the time of a factorisation.
  std::vector<Eigen::Matrix3d> inverse_diagonal_blocks() const;

  std::size_t size() const { return parent_.size(); }
  /// Number of block products of a factorisation, which measures its cost and depends on the order of
  /// elimination.
  std::size_t num_products() const { return num_products_; }
  /// Number of block products of the last factorisation, less than num_products() if it kept columns.
  std::size_t num_last_products() const { return num_last_products_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::vector<std::size_t> count_blocks(const SymmetricBlockMatrix& matrix);
  std::size_t reach(const SymmetricBlockMatrix& matrix, std::uint32_t k);
  bool compute_touched(const SymmetricBlockMatrix& matrix, double lambda);

  std::size_t num_products_ = 0;
  std::size_t num_last_products_ = 0;
  std::vector<std::uint32_t> parent_;      // parent of each node in the elimination tree
  std::vector<std::size_t> column_begin_;  // first block of each column of L
  std::vector<std::size_t> column_end_;    // end of each column; during a factorisation: its next block
  std::vector<std::size_t> capacity_;      // number of blocks for which each column has room
  std::vector<std::uint32_t> rows_;
  std::vector<Eigen::Matrix3d> blocks_;
  std::vector<Eigen::Matrix3d> inverse_diagonal_;  // inverses of the diagonal blocks of L, lower triangular
  std::vector<char> is_touched_;  // columns with changed blocks; in compute_touched(), all columns to compute
  bool has_factor_ = false;       // whether L is that of the matrix, apart from what the changes affect

  std::vector<std::uint32_t> mark_;     // scratch: mark_[i] == k if i was reached for row k
  std::vector<std::uint32_t> pattern_;  // scratch: the columns of row k of L, in topological order
  std::vector<std::uint32_t> path_;     // scratch: part of the path to the root of the elimination tree
  std::vector<std::size_t> first_;      // scratch: the first block of each column in a row to compute
  std::vector<Eigen::Matrix3d> work_;   // scratch: the blocks of one row; zero between rows
};

}  // namespace psi_slam
