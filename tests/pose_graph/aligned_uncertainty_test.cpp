// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/aligned_uncertainty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "added_link.h"
#include "pose_graph/placed_covariances.h"

namespace psi_slam {
namespace {

constexpr std::size_t kChainNodes = 60;
constexpr std::size_t kNodesOfMap = 12;

/// A straight path of 30 m in overlapping local maps.
PoseGraph straight_path() {
  PoseGraph graph;
  for (std::size_t i = 0; i < kChainNodes; ++i) graph.add_node({0.5 * static_cast<double>(i), 0, 0});
  for (std::size_t anchor = 0; anchor + 1 < kChainNodes; anchor += kNodesOfMap / 2)
    for (std::size_t i = anchor + 1; i < std::min(kChainNodes, anchor + kNodesOfMap); ++i)
      add_link(anchor, i, Constraint::Kind::kLocalMap, 0.02, graph);
  return graph;
}

std::vector<std::size_t> all_nodes() {
  std::vector<std::size_t> nodes(kChainNodes);
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

TEST(AlignedUncertainty, does_not_depend_on_the_root) {
  PoseGraph graph = straight_path();
  const auto from_first = aligned_sigmas_m(graph, all_nodes());
  graph.set_root(40);
  const auto from_middle = aligned_sigmas_m(graph, all_nodes());
  for (const std::size_t node : {0, 20, 40, 59}) {
    ASSERT_TRUE(from_first[node] && from_middle[node]);
    EXPECT_NEAR(*from_first[node], *from_middle[node], 1e-3 * *from_first[node]) << node;
  }
}

TEST(AlignedUncertainty, leaves_out_the_growth_with_the_distance_from_the_root) {
  const PoseGraph graph = straight_path();
  const auto sigmas_m = aligned_sigmas_m(graph, all_nodes());
  const auto covariances = placed_covariances(graph);
  EXPECT_LT(*sigmas_m.back(), 0.5 * std::sqrt(covariances.back()->topLeftCorner<2, 2>().trace()));
  EXPECT_GT(*sigmas_m.back(), *sigmas_m[30]) << "the ends of a path are the least certain";
}

TEST(AlignedUncertainty, shrinks_with_loops) {
  PoseGraph graph = straight_path();
  const auto before = aligned_sigmas_m(graph, all_nodes());
  add_link(0, 59, Constraint::Kind::kLoop, 0.01, graph);
  const auto after = aligned_sigmas_m(graph, all_nodes());
  EXPECT_LT(*after.back(), 0.9 * *before.back());
}

TEST(AlignedUncertainty, is_empty_where_the_place_is_unknown) {
  PoseGraph graph = straight_path();
  graph.add_node({100, 0, 0});
  const auto sigmas_m = aligned_sigmas_m(graph, {10, kChainNodes, 20});
  EXPECT_TRUE(sigmas_m[0]);
  EXPECT_FALSE(sigmas_m[1]);
  EXPECT_TRUE(sigmas_m[2]);
  EXPECT_TRUE(aligned_sigmas_m(PoseGraph(), {}).empty());
}

}  // namespace
}  // namespace psi_slam
