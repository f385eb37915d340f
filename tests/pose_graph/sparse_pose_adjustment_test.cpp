// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/pose_graph/sparse_pose_adjustment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "psi_slam/base/user_error.h"
#include "test_graphs.h"

namespace psi_slam {
namespace {

TEST(SparsePoseAdjustment, finds_the_truth_when_there_is_no_noise) {
  KnownGraph known = building(400, 2, 2, 1, 0);
  Measurer measurer(5);
  for (std::size_t i = 1; i < known.truth.size(); ++i)
    known.graph.set_pose(i, compose(known.truth[i], {0.2 * measurer.normal(), 0.2 * measurer.normal(),
                                                     0.1 * measurer.normal()}));
  SparsePoseAdjustment solver;
  const PoseAdjustmentReport report = solver.optimize(known.graph);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.final_chi2, 1e-9);
  EXPECT_LT(max_position_error(known), 1e-6);
}

TEST(SparsePoseAdjustment, names_a_node_that_nothing_links_to_the_root) {
  KnownGraph known = ring(10, 1, 0);
  const auto lost = known.graph.add_node({1, 1, 0});
  known.graph.add_node({2, 1, 0});
  SparsePoseAdjustment solver;
  try {
    solver.optimize(known.graph);
    FAIL() << "no exception";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("node " + std::to_string(lost) + " "));
  }
}

TEST(SparsePoseAdjustment, takes_empty_and_single_node_graphs) {
  PoseGraph graph;
  SparsePoseAdjustment solver;
  EXPECT_TRUE(solver.optimize(graph).converged);
  graph.add_node({1, 2, 3});
  EXPECT_TRUE(solver.optimize(graph).converged);
  EXPECT_EQ(graph.pose(0), TPose2D(1, 2, 3));
}

}  // namespace
}  // namespace psi_slam
