// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/block_ordering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "pose_graph/block_cholesky.h"
#include "test_graphs.h"

namespace psi_slam {
namespace {

using Links = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// The work of a factorisation with this order.
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

TEST(FillReducingOrder, takes_graphs_without_links) {
  EXPECT_TRUE(fill_reducing_order(0, {}).empty());
  EXPECT_EQ(fill_reducing_order(3, {}).size(), 3U);
}

}  // namespace
}  // namespace psi_slam
