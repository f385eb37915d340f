// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/condensed_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "test_graphs.h"

namespace psi_slam {
namespace {

Eigen::Matrix3d random_block(Measurer& measurer) {
  Eigen::Matrix3d block;
  for (int i = 0; i < 9; ++i) block(i / 3, i % 3) = measurer.normal();
  return block;
}

/// Equations of a growing number of variables, and the same equations as dense matrices.
class GrowingEquations {
 public:
  explicit GrowingEquations(std::uint64_t seed) : measurer_(seed) {}

  /// Adds a variable that is linked to some of the others.
  void grow() {
    const std::uint32_t variable = equations.add_variable();
    const Eigen::Index size = 3 * static_cast<Eigen::Index>(variable) + 3;
    h.conservativeResizeLike(Eigen::MatrixXd::Zero(size, size));
    g.conservativeResizeLike(Eigen::VectorXd::Zero(size));
    std::vector<std::uint32_t> others;
    for (int i = 0; variable > 0 && i < 3; ++i)
      others.push_back(static_cast<std::uint32_t>(measurer_.index(variable)));
    for (const std::uint32_t other : others) equations.add_link(variable, other);
    equations.lay_out();
    for (const std::uint32_t other : others) add(variable, other);
    add_diagonal(variable);
  }

  /// Solves both and returns the largest difference of the steps.
  double difference() {
    const Eigen::VectorXd expected = h.ldlt().solve(-g);
    EXPECT_TRUE(equations.solve());
    EXPECT_NEAR(equations.predicted_decrease(), -g.dot(expected), 1e-9 * (1 + g.dot(-expected)));
    double largest = 0;
    for (std::uint32_t i = 0; i < equations.num_variables(); ++i)
      largest = std::max(
          largest,
          (equations.step(i) - expected.segment<3>(3 * static_cast<Eigen::Index>(i))).cwiseAbs().maxCoeff());
    g.setZero();
    return largest;
  }

  void add(std::uint32_t a, std::uint32_t b) {
    const Eigen::Matrix3d block = 0.3 * random_block(measurer_);
    equations.add(a, b, block);
    h.block<3, 3>(3 * a, 3 * b) += block;
    h.block<3, 3>(3 * b, 3 * a) += block.transpose();
  }

  void add_diagonal(std::uint32_t a) {
    const Eigen::Matrix3d block = random_block(measurer_);
    const Eigen::Matrix3d sum = block * block.transpose() + 40 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d gradient(measurer_.normal(), measurer_.normal(), measurer_.normal());
    equations.add(a, sum, gradient);
    h.block<3, 3>(3 * a, 3 * a) += sum;
    g.segment<3>(3 * a) += gradient;
  }

  CondensedEquations equations;
  Eigen::MatrixXd h;
  Eigen::VectorXd g;

 private:
  Measurer measurer_;
};

TEST(CondensedEquations, agree_with_dense_equations_while_they_grow) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    GrowingEquations growing(seed);
    for (std::uint32_t i = 0; i < 60; ++i) {
      growing.grow();
      if (i % 7 == 0) {
        EXPECT_LT(growing.difference(), 1e-12) << i;
      }
      growing.add_diagonal(i / 2);
    }
    EXPECT_LT(growing.difference(), 1e-12);
    EXPECT_EQ(growing.difference(), 0) << "the gradient is zero after a step";
  }
}

TEST(CondensedEquations, keep_their_values_in_a_new_order) {
  GrowingEquations growing(4);
  for (int i = 0; i < 40; ++i) growing.grow();
  growing.equations.lay_out(true);
  EXPECT_LT(growing.difference(), 1e-12);
}

TEST(CondensedEquations, add_a_block_of_a_variable_with_itself_symmetrically) {
  GrowingEquations growing(5);
  growing.grow();
  growing.add(0, 0);
  EXPECT_LT(growing.difference(), 1e-12);
}

TEST(CondensedEquations, find_a_new_order_when_the_present_one_costs_too_much) {
  // A star whose centre comes first: in the order of insertion its elimination links all others.
  CondensedEquations equations;
  equations.add_variable();
  constexpr std::uint32_t kOthers = 50;
  for (std::uint32_t i = 1; i <= kOthers; ++i) {
    equations.add_variable();
    equations.add_link(0, i);
    equations.lay_out();
  }
  EXPECT_LT(equations.num_products(), 5 * kOthers);
}

TEST(CondensedEquations, refuse_a_matrix_that_is_not_positive_definite) {
  CondensedEquations equations;
  equations.add_variable();
  equations.lay_out();
  equations.add(0, -Eigen::Matrix3d::Identity(), Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(equations.solve());
}

}  // namespace
}  // namespace psi_slam
