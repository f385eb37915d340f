// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/false_loop_benchmark.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../pose_graph/test_graphs.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {
namespace {

FalseLoopOptions options_of(FalseLoopKind kind, std::size_t count) {
  FalseLoopOptions options;
  options.kind = kind;
  options.count = count;
  return options;
}

double turn_between(const TPose2D& a, const TPose2D& b) {
  return std::abs(wrap_to_pi(a.phi - b.phi));
}

TEST(FalseLoops, have_the_requested_number_and_are_false) {
  const KnownGraph known = building(600, 2, 2);
  for (const FalseLoopKind kind :
       {FalseLoopKind::kScattered, FalseLoopKind::kGroups, FalseLoopKind::kNearby}) {
    PoseGraph graph = known.graph;
    const FalseLoopOptions options = options_of(kind, 123);
    const std::vector<std::size_t> added = add_false_loops(graph, known.truth, options);
    ASSERT_EQ(added.size(), 123U) << name_of(kind);
    EXPECT_EQ(graph.num_constraints(), known.graph.num_constraints() + 123);
    for (const std::size_t loop : added) {
      const Constraint& constraint = graph.constraint(loop);
      EXPECT_EQ(constraint.kind, Constraint::Kind::kLoop);
      const TPose2D truth = relative_pose(known.truth[constraint.from], known.truth[constraint.to]);
      const double off_m = std::hypot(constraint.from_T_to.x - truth.x, constraint.from_T_to.y - truth.y);
      const double off_rad = turn_between(constraint.from_T_to, truth);
      EXPECT_TRUE(off_m >= 0.999 * options.min_error_m || off_rad >= 0.999 * options.min_error_rad);
      const bool nearby = kind == FalseLoopKind::kNearby;
      EXPECT_LT(off_m, nearby ? options.nearby_m + 0.2 : 1000);
    }
  }
}

TEST(FalseLoops, groups_agree_with_each_other) {
  const KnownGraph known = building(600, 2, 2);
  PoseGraph graph = known.graph;
  const FalseLoopOptions options = options_of(FalseLoopKind::kGroups, 400);
  const std::vector<std::size_t> added = add_false_loops(graph, known.truth, options);
  std::size_t agreeing = 0;
  for (std::size_t i = 1; i < added.size(); ++i) {
    const Constraint& before = graph.constraint(added[i - 1]);
    const Constraint& loop = graph.constraint(added[i]);
    if (loop.from != before.from || loop.to != before.to + 1) continue;
    const TPose2D moved = relative_pose(before.from_T_to, loop.from_T_to);
    const TPose2D truth = relative_pose(known.truth[before.to], known.truth[loop.to]);
    EXPECT_NEAR(moved.x, truth.x, 1e-9);
    EXPECT_NEAR(moved.y, truth.y, 1e-9);
    EXPECT_LT(turn_between(moved, truth), 1e-9);
    ++agreeing;
  }
  EXPECT_GT(agreeing, 400 * 3 / 4) << "a group of five has four such pairs";
}

TEST(FalseLoops, are_the_same_for_the_same_seed) {
  const KnownGraph known = building(300, 2, 2);
  const auto sum_of = [&](std::uint64_t seed) {
    PoseGraph graph = known.graph;
    FalseLoopOptions options = options_of(FalseLoopKind::kScattered, 20);
    options.seed = seed;
    double sum = 0;
    for (const std::size_t loop : add_false_loops(graph, known.truth, options))
      sum += graph.constraint(loop).from_T_to.x;
    return sum;
  };
  EXPECT_EQ(sum_of(1), sum_of(1));
  EXPECT_NE(sum_of(1), sum_of(2));
}

TEST(FalseLoops, a_graph_without_loops_stays_unchanged) {
  KnownGraph known = ring(30, 0, 1);
  EXPECT_TRUE(add_false_loops(known.graph, known.truth, options_of(FalseLoopKind::kScattered, 5)).empty());
}

}  // namespace
}  // namespace psi_slam
