// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/block_products.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "test_graphs.h"

namespace psi_slam {
namespace {

using Blocks = std::vector<Eigen::Matrix3d>;

Blocks random_blocks(std::size_t count, Measurer& measurer) {
  Blocks blocks(count);
  for (Eigen::Matrix3d& block : blocks)
    for (int i = 0; i < 9; ++i) block(i / 3, i % 3) = measurer.normal();
  return blocks;
}

TEST(BlockProducts, are_subtracted_from_the_blocks_of_their_rows) {
  Measurer measurer(1);
  const Blocks factors = random_blocks(40, measurer);
  const Blocks x = random_blocks(1, measurer);
  const Blocks before = random_blocks(100, measurer);
  std::vector<std::uint32_t> rows;
  for (std::uint32_t p = 0; p < factors.size(); ++p) rows.push_back(7 * p % 100);
  Blocks baseline = before;
  block_products_baseline()(factors.data(), rows.data(), rows.size(), x[0], baseline.data());
  Blocks expected = before;
  for (std::size_t p = 0; p < rows.size(); ++p) expected[rows[p]] -= factors[p] * x[0];
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT((baseline[i] - expected[i]).norm(), 1e-14);

  if (block_products() == block_products_baseline())
    GTEST_SKIP() << "this processor has no faster kernel to compare";
  Blocks fastest = before;
  block_products()(factors.data(), rows.data(), rows.size(), x[0], fastest.data());
  EXPECT_EQ(std::memcmp(fastest.data(), baseline.data(), baseline.size() * sizeof(Eigen::Matrix3d)), 0);
}

}  // namespace
}  // namespace psi_slam
