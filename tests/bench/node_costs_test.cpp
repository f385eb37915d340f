// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/node_costs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random_draws.h"

namespace psi_slam {
namespace {

FrameRecord frame(bool is_node, int loops_tried, std::int64_t evaluations) {
  FrameRecord record;
  if (is_node) record.node = 0;
  record.loops_tried = loops_tried;
  record.evaluations = evaluations;
  return record;
}

TEST(NodeCosts, quantile_is_the_least_value_that_the_share_does_not_exceed) {
  RandomDraws draws(3, "values", 0);
  for (const std::size_t count : {1U, 2U, 7U, 100U, 101U}) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(draws.normal());
    for (const double share : {0.5, 0.99, 1.0}) {
      const double value = quantile(values, share);
      const auto not_above = [&](double limit) {
        return std::count_if(values.begin(), values.end(), [&](double other) { return other <= limit; });
      };
      const double least = share * static_cast<double>(count);
      EXPECT_GE(static_cast<double>(not_above(value)), least);
      for (const double other : values)
        if (other < value) {
          EXPECT_LT(static_cast<double>(not_above(other)), least);
        }
    }
  }
  EXPECT_EQ(quantile({}, 0.5), 0);
}

TEST(NodeCosts, compare_all_nodes_with_the_median_of_those_that_tried_loops) {
  const std::vector<FrameRecord> frames{frame(true, 0, 900),    frame(true, 1, 100), frame(true, 2, 200),
                                        frame(false, 0, 50000), frame(true, 4, 300), frame(true, 0, 10)};
  const NodeCosts costs = node_costs(frames, {1, 2, 4, 1000, 30, 3});
  EXPECT_EQ(costs.p50_ms, 3);
  EXPECT_EQ(costs.p99_ms, 30);
  EXPECT_EQ(costs.max_ms, 30) << "the scan of 1 s is no node";
  EXPECT_EQ(costs.time_ratio, 30 / 4.0);
  EXPECT_EQ(costs.evaluations_ratio, 900 / 200.0);
}

TEST(NodeCosts, have_no_ratio_without_loops) {
  const NodeCosts costs = node_costs({frame(true, 0, 5)}, {2});
  EXPECT_EQ(costs.max_ms, 2);
  EXPECT_FALSE(costs.time_ratio);
  EXPECT_FALSE(costs.evaluations_ratio);
  EXPECT_EQ(node_costs({}, {}).max_ms, 0);
}

}  // namespace
}  // namespace psi_slam
