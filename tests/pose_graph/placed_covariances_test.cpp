// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/placed_covariances.h"

#include <gtest/gtest.h>

#include "added_link.h"
#include "pose_graph/shared_errors.h"

namespace psi_slam {
namespace {

constexpr std::size_t kRunNodes = 10;

// Two runs of ten nodes in one local map each, without a constraint between them.
PoseGraph two_runs() {
  PoseGraph graph;
  for (std::size_t i = 0; i < 2 * kRunNodes; ++i) graph.add_node({0.5 * static_cast<double>(i), 0, 0});
  for (const std::size_t anchor : {std::size_t{0}, kRunNodes})
    for (std::size_t i = 1; i < kRunNodes; ++i)
      add_link(anchor, anchor + i, Constraint::Kind::kLocalMap, 0.02, graph);
  return graph;
}

std::size_t count_known(const PoseGraph& graph) {
  std::size_t known = 0;
  for (const auto& covariance : placed_covariances(graph)) known += covariance ? 1 : 0;
  return known;
}

TEST(PlacedCovariances, are_those_of_all_nodes_if_all_are_placed) {
  PoseGraph graph = two_runs();
  add_link(9, 10, Constraint::Kind::kRunStart, 0.3, graph);
  const std::vector<Eigen::Matrix3d> expected = pose_covariances(graph);
  const auto covariances = placed_covariances(graph);
  ASSERT_EQ(covariances.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(covariances[i], expected[i]) << i;
}

TEST(PlacedCovariances, are_empty_in_a_run_that_was_never_placed) {
  PoseGraph graph = two_runs();
  EXPECT_EQ(count_known(graph), kRunNodes) << "without a constraint between the runs";
  add_link(9, 10, Constraint::Kind::kRunStart, kProvisionalSigma_m, graph);
  const auto covariances = placed_covariances(graph);
  ASSERT_EQ(covariances.size(), 2 * kRunNodes);
  for (std::size_t i = 0; i < covariances.size(); ++i) EXPECT_EQ(covariances[i].has_value(), i < kRunNodes);

  const std::size_t loop = add_link(3, 15, Constraint::Kind::kLoop, 0.02, graph);
  EXPECT_EQ(count_known(graph), 2 * kRunNodes) << "the loop places the second run";
  graph.set_enabled(loop, false);
  EXPECT_EQ(count_known(graph), kRunNodes);
}

TEST(PlacedCovariances, are_empty_if_a_constraint_is_singular) {
  PoseGraph graph;
  EXPECT_TRUE(placed_covariances(graph).empty());
  graph.add_node({0, 0, 0});
  EXPECT_EQ(count_known(graph), 1U);
  graph.add_node({1, 0, 0});
  Constraint flat;
  flat.to = 1;
  flat.information(2, 2) = 0;
  flat.kind = Constraint::Kind::kLocalMap;
  graph.add_constraint(flat);
  EXPECT_EQ(count_known(graph), 0U);
}

}  // namespace
}  // namespace psi_slam
