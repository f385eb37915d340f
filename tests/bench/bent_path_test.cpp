// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/bent_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kWalkNodes = 401;

struct Walk {
  std::vector<TPose2D> poses{{1, 2, 0.3}};
  PoseGraph graph;

  // Constraints without noise: odometry, every tenth node as the anchor of a local map of 30 nodes, and a
  // loop.
  Walk() {
    while (poses.size() < kWalkNodes) poses.push_back(compose(poses.back(), TPose2D(0.2, 0.01, 0.02)));
    for (const TPose2D& pose : poses) graph.add_node(pose);
    for (std::size_t to = 1; to < kWalkNodes; ++to) {
      join(to - 1, to, Constraint::Kind::kOdometry);
      for (std::size_t from = to / 10 * 10; from + 30 > to && from < to; from -= 10) {
        join(from, to, Constraint::Kind::kLocalMap);
        if (from == 0) break;
      }
    }
    join(5, 395, Constraint::Kind::kLoop);
    graph.set_enabled(3, false);
    graph.set_root(7);
  }

  void join(std::size_t from, std::size_t to, Constraint::Kind kind) {
    Constraint constraint;
    constraint.from = from;
    constraint.to = to;
    constraint.from_T_to = between(poses[from], poses[to]);
    constraint.kind = kind;
    graph.add_constraint(constraint);
  }
};

void expect_equal(const TPose2D& a, const TPose2D& b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
  EXPECT_NEAR(std::remainder(a.phi - b.phi, 2 * M_PI), 0, 1e-9);
}

BentPathOptions with_share(double share) {
  BentPathOptions options;
  options.share = share;
  return options;
}

TEST(BentPath, without_bent_stretches_is_the_path) {
  const Walk walk;
  const BentPath path = bent(walk.graph, walk.poses, with_share(0));
  EXPECT_EQ(path.stretches, 0U);
  ASSERT_EQ(path.unlooped.size(), kWalkNodes);
  for (std::size_t node = 0; node < kWalkNodes; ++node) expect_equal(path.unlooped[node], walk.poses[node]);
  ASSERT_EQ(path.graph.num_constraints(), walk.graph.num_constraints());
  for (std::size_t i = 0; i < path.graph.num_constraints(); ++i)
    expect_equal(path.graph.constraint(i).from_T_to, walk.graph.constraint(i).from_T_to);
  EXPECT_TRUE(path.graph.enabled(2));
  EXPECT_FALSE(path.graph.enabled(3));
  EXPECT_EQ(path.graph.root(), 7U);
  for (std::size_t node = 0; node < kWalkNodes; ++node)
    expect_equal(path.graph.pose(node), walk.graph.pose(node));
}

TEST(BentPath, stretches_are_5_percent_off_or_turn_by_2_degrees) {
  const Walk walk;
  const BentPath path = bent(walk.graph, walk.poses, with_share(1));
  EXPECT_EQ(path.stretches, 8U);
  for (std::size_t stretch = 0; stretch < 8; ++stretch) {
    double length_m = 0, before_m = 0;
    for (std::size_t node = 50 * stretch + 1; node <= 50 * stretch + 50; ++node) {
      const TPose2D step = between(path.unlooped[node - 1], path.unlooped[node]);
      const TPose2D true_step = between(walk.poses[node - 1], walk.poses[node]);
      length_m += std::hypot(step.x, step.y);
      before_m += std::hypot(true_step.x, true_step.y);
    }
    const double turn =
        between(path.unlooped[50 * stretch], path.unlooped[50 * stretch + 50]).phi - 50 * 0.02;
    EXPECT_NEAR(std::abs(length_m / before_m - 1), stretch % 2 == 0 ? 0.05 : 0, 1e-9);
    EXPECT_NEAR(std::abs(turn), stretch % 2 == 0 ? 0 : 2 * M_PI / 180, 1e-9);
  }
}

TEST(BentPath, its_constraints_measure_the_bent_path_but_loops_the_true_one) {
  const Walk walk;
  const BentPath path = bent(walk.graph, walk.poses, with_share(0.5));
  EXPECT_EQ(path.stretches, 4U);
  for (const Constraint& constraint : path.graph.constraints()) {
    const bool loop = constraint.kind == Constraint::Kind::kLoop;
    const std::vector<TPose2D>& measured = loop ? walk.poses : path.unlooped;
    expect_equal(constraint.from_T_to, between(measured[constraint.from], measured[constraint.to]));
  }
}

}  // namespace
}  // namespace psi_slam
