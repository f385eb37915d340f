// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/block_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <map>
#include <numeric>

#include "test_graphs.h"

namespace psi_slam {
namespace {

// Returns a random positive definite matrix. Blocks next to the diagonal are nonzero, other blocks with the
// probability `density`.
SymmetricBlockMatrix random_matrix(std::size_t n, double density, std::uint64_t seed) {
  Measurer measurer(seed);
  SymmetricBlockMatrix matrix;
  matrix.column_begin.push_back(0);
  std::vector<double> weight(n, 1);
  for (std::uint32_t k = 0; k < n; ++k) {
    for (std::uint32_t i = 0; i < k; ++i) {
      if (measurer.uniform() > density && i + 1 != k) continue;
      Eigen::Matrix3d block;
      for (int c = 0; c < 9; ++c) block(c / 3, c % 3) = measurer.normal();
      matrix.rows.push_back(i);
      matrix.blocks.push_back(block);
      weight[i] += block.cwiseAbs().sum();
      weight[k] += block.cwiseAbs().sum();
    }
    matrix.column_begin.push_back(matrix.rows.size());
  }
  for (std::size_t k = 0; k < n; ++k) {
    Eigen::Matrix3d diagonal = weight[k] * Eigen::Matrix3d::Identity();
    diagonal(0, 1) = diagonal(1, 0) = 0.3;
    diagonal(0, 2) = diagonal(2, 0) = -0.2;
    matrix.diagonal.push_back(diagonal);
  }
  return matrix;
}

Eigen::MatrixXd dense(const SymmetricBlockMatrix& matrix) {
  const auto n = static_cast<Eigen::Index>(matrix.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    result.block<3, 3>(3 * k, 3 * k) = matrix.diagonal[k];
    for (std::size_t p = matrix.column_begin[k]; p < matrix.column_begin[k + 1]; ++p) {
      result.block<3, 3>(3 * matrix.rows[p], 3 * k) = matrix.blocks[p];
      result.block<3, 3>(3 * k, 3 * matrix.rows[p]) = matrix.blocks[p].transpose();
    }
  }
  return result;
}

TEST(BlockCholesky, solves_as_a_dense_factorisation_does) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SymmetricBlockMatrix matrix = random_matrix(5 + 3 * seed, 0.02 * static_cast<double>(seed), seed);
    BlockCholesky cholesky;
    cholesky.analyze(matrix);
    const Eigen::MatrixXd a = dense(matrix);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(a.rows(), -1, 2);
    ASSERT_TRUE(cholesky.factorize(matrix));
    Eigen::VectorXd x = b;
    cholesky.solve(x);
    EXPECT_LT((x - a.ldlt().solve(b)).norm(), 1e-12 * b.norm());

    constexpr double kLambda = 0.5;
    const Eigen::MatrixXd damped = a + kLambda * Eigen::MatrixXd(a.diagonal().asDiagonal());
    ASSERT_TRUE(cholesky.factorize(matrix, kLambda)) << "the symbolic factorisation is reused";
    x = b;
    cholesky.solve(x);
    EXPECT_LT((x - damped.ldlt().solve(b)).norm(), 1e-12 * b.norm());
  }
}

bool has_bytes_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() && std::equal(a.data(), a.data() + a.size(), b.data());
}

// Returns a matrix with further blocks, and with further rows at its end.
SymmetricBlockMatrix extended(const SymmetricBlockMatrix& matrix, std::size_t rows, Measurer& measurer,
                              std::vector<std::uint32_t>& inserted) {
  SymmetricBlockMatrix result;
  result.column_begin.push_back(0);
  result.diagonal = matrix.diagonal;
  result.diagonal.resize(matrix.size() + rows, 50 * Eigen::Matrix3d::Identity());
  for (std::uint32_t k = 0; k < result.size(); ++k) {
    std::size_t p = k < matrix.size() ? matrix.column_begin[k] : 0;
    const std::size_t end = k < matrix.size() ? matrix.column_begin[k + 1] : 0;
    for (std::uint32_t i = 0; i < k; ++i) {
      const bool known = p < end && matrix.rows[p] == i;
      if (!known && measurer.uniform() > 0.001 && (k < matrix.size() || i + 1 != k)) continue;
      if (!known) inserted.push_back(i);
      result.rows.push_back(i);
      result.blocks.push_back(known ? matrix.blocks[p++] : Eigen::Matrix3d::Constant(measurer.normal()));
    }
    result.column_begin.push_back(result.rows.size());
  }
  return result;
}

TEST(BlockCholesky, refactorises_what_has_changed_to_the_last_bit) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Measurer measurer(seed);
    SymmetricBlockMatrix matrix = random_matrix(60, 0.01, seed);
    BlockCholesky growing;
    growing.analyze(matrix);
    std::size_t all_products = 0;
    std::size_t computed_products = 0;
    for (int change = 0; change < 40; ++change) {
      if (change % 3 == 2) {
        std::vector<std::uint32_t> inserted;
        matrix = extended(matrix, measurer.index(3), measurer, inserted);
        for (const std::uint32_t row : inserted) growing.touch(row);
        growing.extend(matrix);
      }
      const std::size_t row = measurer.index(matrix.size());
      growing.touch(static_cast<std::uint32_t>(row));
      matrix.diagonal[row](1, 1) += measurer.uniform();
      const std::size_t block = measurer.index(matrix.blocks.size());
      growing.touch(matrix.rows[block]);
      matrix.blocks[block](2, 1) += 0.1 * measurer.normal();

      BlockCholesky fresh;
      fresh.analyze(matrix);
      ASSERT_TRUE(fresh.factorize(matrix));
      ASSERT_TRUE(growing.refactorize(matrix));
      EXPECT_EQ(growing.num_products(), fresh.num_products());
      EXPECT_LE(growing.num_last_products(), fresh.num_last_products());
      all_products += fresh.num_last_products();
      computed_products += growing.num_last_products();
      Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(3 * static_cast<Eigen::Index>(matrix.size()), -1, 2);
      Eigen::VectorXd y = x;
      growing.solve(x);
      fresh.solve(y);
      ASSERT_TRUE(has_bytes_of(x, y)) << change;
    }
    EXPECT_LT(computed_products, all_products) << "columns that no change reaches were kept";
  }
}

TEST(BlockCholesky, refactorises_after_a_matrix_that_is_not_positive_definite) {
  SymmetricBlockMatrix matrix = random_matrix(30, 0.1, 6);
  BlockCholesky cholesky;
  cholesky.analyze(matrix);
  ASSERT_TRUE(cholesky.factorize(matrix));
  Eigen::VectorXd expected = Eigen::VectorXd::Ones(90);
  cholesky.solve(expected);
  const Eigen::Matrix3d sound = matrix.diagonal[17];
  matrix.diagonal[17](2, 2) = -1;
  cholesky.touch(17);
  EXPECT_FALSE(cholesky.refactorize(matrix));
  matrix.diagonal[17] = sound;
  cholesky.touch(17);
  ASSERT_TRUE(cholesky.refactorize(matrix));
  Eigen::VectorXd x = Eigen::VectorXd::Ones(90);
  cholesky.solve(x);
  EXPECT_TRUE(has_bytes_of(x, expected));
}

TEST(BlockCholesky, finds_the_diagonal_blocks_of_the_dense_inverse) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SymmetricBlockMatrix matrix = random_matrix(5 + 3 * seed, 0.02 * static_cast<double>(seed), seed);
    BlockCholesky cholesky;
    cholesky.analyze(matrix);
    ASSERT_TRUE(cholesky.factorize(matrix));
    const Eigen::MatrixXd inverse = dense(matrix).inverse();
    const std::vector<Eigen::Matrix3d> blocks = cholesky.inverse_diagonal_blocks();
    ASSERT_EQ(blocks.size(), matrix.size());
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(k);
      const Eigen::Matrix3d expected = inverse.block<3, 3>(row, row);
      EXPECT_LT((blocks[k] - expected).norm(), 1e-12 * expected.norm()) << k;
    }
  }
}

TEST(BlockCholesky, solves_as_the_sparse_factorisation_of_Eigen_does) {
  const SymmetricBlockMatrix matrix = random_matrix(400, 0.005, 3);
  BlockCholesky cholesky;
  cholesky.analyze(matrix);
  ASSERT_TRUE(cholesky.factorize(matrix));
  const Eigen::MatrixXd a = dense(matrix);
  const Eigen::SparseMatrix<double> sparse = a.sparseView();
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> reference(sparse);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(a.rows(), -1, 2);
  Eigen::VectorXd x = b;
  cholesky.solve(x);
  EXPECT_LT((x - reference.solve(b)).norm(), 1e-12 * b.norm());
}

TEST(BlockCholesky, reports_a_matrix_that_is_not_positive_definite_and_recovers) {
  SymmetricBlockMatrix matrix = random_matrix(30, 0.1, 4);
  BlockCholesky cholesky;
  cholesky.analyze(matrix);
  const Eigen::Matrix3d sound = matrix.diagonal[17];
  matrix.diagonal[17](2, 2) = -1;
  EXPECT_FALSE(cholesky.factorize(matrix));
  matrix.diagonal[17].setZero();
  EXPECT_FALSE(cholesky.factorize(matrix));
  matrix.diagonal[17](0, 0) = std::nan("");
  EXPECT_FALSE(cholesky.factorize(matrix));
  matrix.diagonal[17] = sound;
  ASSERT_TRUE(cholesky.factorize(matrix));
  const Eigen::MatrixXd a = dense(matrix);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(a.rows());
  cholesky.solve(x);
  EXPECT_LT((a * x - Eigen::VectorXd::Ones(a.rows())).norm(), 1e-12);
}

TEST(BlockCholesky, gives_any_block_of_the_inverse) {
  const SymmetricBlockMatrix matrix = random_matrix(40, 0.05, 5);
  BlockCholesky cholesky;
  cholesky.analyze(matrix);
  ASSERT_TRUE(cholesky.factorize(matrix));
  const Eigen::MatrixXd inverse = dense(matrix).inverse();
  std::vector<std::map<std::uint32_t, Eigen::Matrix3d>> columns(matrix.size());
  for (std::size_t k = 0; k < matrix.size(); ++k) {
    const BlockCholesky::InverseColumns y = cholesky.inverse_columns(k);
    for (std::size_t p = 0; p < y.rows.size(); ++p) columns[k][y.rows[p]] = y.blocks[p];
  }
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    for (std::size_t j = 0; j < matrix.size(); ++j) {
      Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
      for (const auto& [row, y] : columns[i])
        if (columns[j].count(row) != 0) block += y.transpose() * columns[j][row];
      const Eigen::Matrix3d expected =
          inverse.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j));
      EXPECT_LT((block - expected).norm(), 1e-14);
    }
  }
}

using Links = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// Returns the number of block products of a factorisation with this order of elimination.
std::size_t products(std::size_t n, const Links& links, const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> place(n);
  for (std::uint32_t k = 0; k < n; ++k) place[order[k]] = k;
  std::vector<std::vector<std::uint32_t>> columns(n);
  for (const auto& [a, b] : links)
    columns[std::max(place[a], place[b])].push_back(std::min(place[a], place[b]));
  SymmetricBlockMatrix matrix;
  matrix.column_begin.push_back(0);
  for (std::vector<std::uint32_t>& column : columns) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    matrix.rows.insert(matrix.rows.end(), column.begin(), column.end());
    matrix.column_begin.push_back(matrix.rows.size());
  }
  matrix.blocks.resize(matrix.rows.size());
  matrix.diagonal.resize(n);
  BlockCholesky cholesky;
  cholesky.analyze(matrix);
  return cholesky.num_products();
}

TEST(FillReducingOrder, eliminates_the_hub_of_a_star_last) {
  Links links;
  for (std::uint32_t i = 1; i < 50; ++i) links.emplace_back(0, i);
  const std::vector<std::uint32_t> order = fill_reducing_order(50, links);
  EXPECT_GE(std::find(order.begin(), order.end(), 0U) - order.begin(), 48);
  EXPECT_LT(products(50, links, order), 200U);
}

TEST(FillReducingOrder, is_a_permutation_and_better_than_the_order_of_time) {
  const KnownGraph known = building(1000, 2, 2);
  Links links;
  for (const GraphLink& link : known.graph.links()) links.emplace_back(link.from, link.to);
  const std::vector<std::uint32_t> order = fill_reducing_order(1000, links);
  std::vector<std::uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> natural(1000);
  std::iota(natural.begin(), natural.end(), 0U);
  EXPECT_EQ(sorted, natural);
  EXPECT_LT(5 * products(1000, links, order), products(1000, links, natural));
  EXPECT_EQ(order, fill_reducing_order(1000, links));
}

TEST(FillReducingOrder, accepts_graphs_without_links) {
  EXPECT_TRUE(fill_reducing_order(0, {}).empty());
  EXPECT_EQ(fill_reducing_order(3, {}).size(), 3U);
}

}  // namespace
}  // namespace psi_slam
