// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/block_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <map>

#include "test_graphs.h"

namespace psi_slam {
namespace {

// A positive definite matrix with the given share of its blocks.
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
    ASSERT_TRUE(cholesky.factorize(matrix, kLambda)) << "the symbolic factorisation serves again";
    x = b;
    cholesky.solve(x);
    EXPECT_LT((x - damped.ldlt().solve(b)).norm(), 1e-12 * b.norm());
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

TEST(BlockCholesky, says_when_a_matrix_is_not_positive_definite_and_recovers) {
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

}  // namespace
}  // namespace psi_slam
