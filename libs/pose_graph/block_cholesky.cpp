// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/block_cholesky.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pose_graph/block_products.h"

namespace psi_slam {
namespace {

using Eigen::Matrix3d;

}  // namespace

bool invert_cholesky_factor(const Matrix3d& a, const Eigen::Vector3d& original_diagonal, Matrix3d& inverse) {
  constexpr double kRounding = 1e-15;
  const auto is_pivot = [&](double pivot, int i) { return pivot > kRounding * original_diagonal[i]; };
  const double p0 = a(0, 0);
  if (!is_pivot(p0, 0)) return false;
  const double l00 = std::sqrt(p0);
  const double l10 = a(1, 0) / l00;
  const double l20 = a(2, 0) / l00;
  const double p1 = a(1, 1) - l10 * l10;
  if (!is_pivot(p1, 1)) return false;
  const double l11 = std::sqrt(p1);
  const double l21 = (a(2, 1) - l20 * l10) / l11;
  const double p2 = a(2, 2) - l20 * l20 - l21 * l21;
  if (!is_pivot(p2, 2) || !std::isfinite(p0 + p1 + p2)) return false;
  const double i00 = 1 / l00;
  const double i11 = 1 / l11;
  const double i22 = 1 / std::sqrt(p2);
  const double i10 = -l10 * i00 * i11;
  inverse << i00, 0, 0,  //
      i10, i11, 0,       //
      -(l20 * i00 + l21 * i10) * i22, -l21 * i11 * i22, i22;
  return true;
}

std::vector<std::uint32_t> fill_reducing_order(
    std::size_t num_variables, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& links) {
  using Pattern = Eigen::SparseMatrix<float, Eigen::ColMajor, int>;
  const auto size = static_cast<int>(num_variables);
  std::vector<Eigen::Triplet<float, int>> entries;
  entries.reserve(links.size() + num_variables);
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1.0F);
  for (const auto& [row, column] : links)
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), 1.0F);
  Pattern pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  const auto& indices = permutation.indices();
  return {indices.data(), indices.data() + indices.size()};
}

// Puts the columns of row k of L in topological order at the end of pattern_. Returns the index of the first
// of these columns in pattern_.
std::size_t BlockCholesky::reach(const SymmetricBlockMatrix& matrix, std::uint32_t k) {
  std::size_t top = size();
  mark_[k] = k;
  for (std::size_t p = matrix.column_begin[k]; p < matrix.column_begin[k + 1]; ++p) {
    std::size_t length = 0;
    for (std::uint32_t i = matrix.rows[p]; mark_[i] != k; i = parent_[i]) {
      path_[length++] = i;
      mark_[i] = k;
    }
    while (length > 0) pattern_[--top] = path_[--length];
  }
  return top;
}

// Computes the elimination tree and num_products_. Returns the number of blocks of each column of L.
std::vector<std::size_t> BlockCholesky::count_blocks(const SymmetricBlockMatrix& matrix) {
  const std::size_t n = matrix.size();
  parent_.assign(n, kNone);
  mark_.assign(n, kNone);
  pattern_.resize(n);
  path_.resize(n);
  first_.resize(n);
  work_.resize(n, Matrix3d::Zero());
  inverse_diagonal_.resize(n);
  is_touched_.resize(n, 1);
  std::vector<std::size_t> count(n, 0);
  for (std::uint32_t k = 0; k < n; ++k) {
    mark_[k] = k;
    for (std::size_t p = matrix.column_begin[k]; p < matrix.column_begin[k + 1]; ++p) {
      for (std::uint32_t i = matrix.rows[p]; mark_[i] != k; i = parent_[i]) {
        if (parent_[i] == kNone) parent_[i] = k;
        ++count[i];
        mark_[i] = k;
      }
    }
  }
  num_products_ = 0;
  for (const std::size_t blocks : count) num_products_ += blocks * (blocks + 3) / 2;
  return count;
}

void BlockCholesky::analyze(const SymmetricBlockMatrix& matrix) {
  capacity_ = count_blocks(matrix);
  column_begin_.assign(matrix.size(), 0);
  for (std::size_t i = 0; i + 1 < matrix.size(); ++i) column_begin_[i + 1] = column_begin_[i] + capacity_[i];
  column_end_ = column_begin_;
  const std::size_t blocks = matrix.size() == 0 ? 0 : column_begin_.back() + capacity_.back();
  rows_.resize(blocks);
  blocks_.resize(blocks);
  has_factor_ = false;
}

// Columns that have outgrown their room move to the end. All their blocks will be computed.
void BlockCholesky::extend(const SymmetricBlockMatrix& matrix) {
  constexpr std::size_t kMostUnused = 4;  // times the blocks of L
  const std::vector<std::size_t> count = count_blocks(matrix);
  if (rows_.size() > kMostUnused * std::accumulate(count.begin(), count.end(), matrix.size()))
    return analyze(matrix);
  column_begin_.resize(matrix.size(), 0);
  column_end_.resize(matrix.size(), 0);
  capacity_.resize(matrix.size(), 0);
  std::size_t blocks = rows_.size();
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    if (count[i] <= capacity_[i]) continue;
    column_begin_[i] = column_end_[i] = blocks;
    capacity_[i] = count[i] + count[i] / 2;
    blocks += capacity_[i];
  }
  rows_.resize(blocks);
  blocks_.resize(blocks);
}

void BlockCholesky::touch(std::uint32_t i) {
  is_touched_.resize(std::max<std::size_t>(is_touched_.size(), i + 1), 1);
  is_touched_[i] = 1;
}

bool BlockCholesky::factorize(const SymmetricBlockMatrix& matrix, double lambda) {
  std::fill(is_touched_.begin(), is_touched_.end(), char{1});
  return compute_touched(matrix, lambda);
}

// A changed block (i, k) changes L in column i. The rows of a column of L lie on its path to the root, so
// only the columns on that path change.
bool BlockCholesky::refactorize(const SymmetricBlockMatrix& matrix) {
  if (!has_factor_) return factorize(matrix);
  for (std::size_t i = 0; i < size(); ++i)
    if (is_touched_[i] != 0 && parent_[i] != kNone) is_touched_[parent_[i]] = 1;
  return compute_touched(matrix, 0);
}

// Computes the touched columns of L. They include the paths from each touched column to the root. So the last
// rows of any other column are touched, and its blocks in these rows are needed but do not change.
bool BlockCholesky::compute_touched(const SymmetricBlockMatrix& matrix, double lambda) {
  const std::size_t n = size();
  const BlockProducts subtract_products = block_products();
  has_factor_ = false;
  num_last_products_ = 0;
  std::fill(mark_.begin(), mark_.end(), kNone);
  for (std::size_t i = 0; i < n; ++i) {
    const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(column_begin_[i]);
    const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(column_end_[i]);
    const auto is_kept = [&](std::uint32_t row) { return is_touched_[row] == 0; };
    const auto first = is_touched_[i] != 0 ? begin : std::partition_point(begin, end, is_kept);
    first_[i] = column_end_[i] = static_cast<std::size_t>(first - rows_.begin());
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    if (is_touched_[k] == 0) continue;
    const std::size_t top = reach(matrix, k);
    for (std::size_t p = matrix.column_begin[k]; p < matrix.column_begin[k + 1]; ++p)
      work_[matrix.rows[p]] = matrix.blocks[p];
    Matrix3d diagonal = matrix.diagonal[k];
    diagonal.diagonal() *= 1 + lambda;
    for (std::size_t t = top; t < n; ++t) {
      const std::uint32_t i = pattern_[t];
      const std::size_t here = column_end_[i]++;
      if (is_touched_[i] != 0) {
        rows_[here] = k;
        blocks_[here] = (inverse_diagonal_[i] * work_[i]).transpose();
      }
      num_last_products_ += here - first_[i] + 1;
      const Matrix3d x = blocks_[here].transpose();
      work_[i].setZero();
      subtract_products(blocks_.data() + first_[i], rows_.data() + first_[i], here - first_[i], x,
                        work_.data());
      diagonal.noalias() -= x.transpose() * x;
    }
    if (!invert_cholesky_factor(diagonal, matrix.diagonal[k].diagonal(), inverse_diagonal_[k])) return false;
  }
  std::fill(is_touched_.begin(), is_touched_.end(), char{0});
  has_factor_ = lambda == 0;
  return true;
}

void BlockCholesky::solve(Eigen::VectorXd& b) const {
  const std::size_t n = size();
  for (std::size_t k = 0; k < n; ++k) {
    auto head = b.segment<3>(3 * static_cast<Eigen::Index>(k));
    const Eigen::Vector3d x = inverse_diagonal_[k] * head;
    head = x;
    for (std::size_t p = column_begin_[k]; p < column_end_[k]; ++p)
      b.segment<3>(3 * static_cast<Eigen::Index>(rows_[p])).noalias() -= blocks_[p] * x;
  }
  for (std::size_t k = n; k-- > 0;) {
    auto head = b.segment<3>(3 * static_cast<Eigen::Index>(k));
    Eigen::Vector3d x = head;
    for (std::size_t p = column_begin_[k]; p < column_end_[k]; ++p)
      x.noalias() -= blocks_[p].transpose() * b.segment<3>(3 * static_cast<Eigen::Index>(rows_[p]));
    head.noalias() = inverse_diagonal_[k].transpose() * x;
  }
}

BlockCholesky::InverseColumns BlockCholesky::inverse_columns(std::size_t k) const {
  InverseColumns result;
  const BlockProducts subtract_products = block_products();
  std::size_t height = 0;
  for (auto i = static_cast<std::uint32_t>(k); i != kNone; i = parent_[i]) ++height;
  result.rows.reserve(height);
  for (auto i = static_cast<std::uint32_t>(k); i != kNone; i = parent_[i]) result.rows.push_back(i);
  result.blocks.assign(height, Matrix3d::Zero());
  result.blocks.front().setIdentity();
  for (std::size_t step = 0; step < height; ++step) {
    const std::uint32_t column = result.rows[step];
    const Matrix3d x = inverse_diagonal_[column] * result.blocks[step];
    result.blocks[step] = x;
    std::size_t target = step + 1;  // the rows of a column of L lie on the column's path to the root
    for (std::size_t p = column_begin_[column]; p < column_end_[column]; ++p) {
      while (result.rows[target] != rows_[p]) ++target;
      const auto at = static_cast<std::uint32_t>(target);
      subtract_products(&blocks_[p], &at, 1, x, result.blocks.data());
    }
  }
  return result;
}

// With Z = A^-1, Z L = L^-T is upper triangular. Its columns give those of Z from the last to the first. The
// rows of a column of L, except the first, are among those of the columns of L with these numbers. So all
// blocks of Z that a column needs are known.
std::vector<Matrix3d> BlockCholesky::inverse_diagonal_blocks() const {
  std::vector<Matrix3d> diagonal(size());
  std::vector<Matrix3d> below(blocks_.size());  // blocks of Z at the places of the blocks of L
  for (std::size_t j = size(); j-- > 0;) {
    const std::size_t begin = column_begin_[j];
    const std::size_t end = column_end_[j];
    for (std::size_t p = begin; p < end; ++p) below[p].setZero();
    for (std::size_t q = begin; q < end; ++q) {
      const std::uint32_t k = rows_[q];
      below[q].noalias() -= diagonal[k] * blocks_[q];
      std::size_t z = column_begin_[k];
      for (std::size_t p = q + 1; p < end; ++p) {
        while (rows_[z] != rows_[p]) ++z;
        below[p].noalias() -= below[z] * blocks_[q];
        below[q].noalias() -= below[z].transpose() * blocks_[p];
      }
    }
    Matrix3d sum = inverse_diagonal_[j].transpose();
    for (std::size_t p = begin; p < end; ++p) {
      below[p] = Matrix3d(below[p] * inverse_diagonal_[j]);
      sum.noalias() -= below[p].transpose() * blocks_[p];
    }
    const Matrix3d block = sum * inverse_diagonal_[j];
    diagonal[j] = (block + block.transpose()) / 2;
  }
  return diagonal;
}

}  // namespace psi_slam
