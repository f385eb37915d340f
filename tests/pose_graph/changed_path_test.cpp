// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/changed_path.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace psi_slam {
namespace {

TEST(ChangedPath, keeps_all_but_the_constraints_of_the_front_end) {
  PoseGraph graph;
  for (int i = 0; i < 3; ++i) graph.add_node({1.0 * i, 2.0 * i, 0.1 * i});
  graph.set_root(1);
  for (const Constraint::Kind kind :
       {Constraint::Kind::kOdometry, Constraint::Kind::kLocalMap, Constraint::Kind::kRunStart,
        Constraint::Kind::kLoop, Constraint::Kind::kKnown}) {
    Constraint constraint;
    constraint.to = 2;
    constraint.kind = kind;
    graph.add_constraint(constraint);
  }
  graph.set_enabled(3, false);

  const PoseGraph changed =
      with_changed_path(graph, [](Constraint& constraint) { constraint.from_T_to.x = 7; });
  ASSERT_EQ(changed.num_constraints(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(changed.constraint(i).kind, graph.constraint(i).kind);
    EXPECT_EQ(changed.constraint(i).from_T_to.x, i < 2 ? 7 : 0) << i;
    EXPECT_EQ(changed.enabled(i), i != 3) << i;
  }
  EXPECT_EQ(changed.root(), 1U);
  ASSERT_EQ(changed.num_nodes(), 3U);
  EXPECT_EQ(changed.pose(2).y, 4);
}

}  // namespace
}  // namespace psi_slam
