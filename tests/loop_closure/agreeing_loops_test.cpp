// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/agreeing_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Nodes on a line, one metre apart, which face along it.
PoseGraph straight_path() {
  PoseGraph graph;
  for (int i = 0; i < 40; ++i) graph.add_node({static_cast<double>(i), 0, 0});
  return graph;
}

// Adds a disabled loop that wants to move the later of two nodes by `move`, along the axes of the map.
std::size_t add_moving_loop(PoseGraph& graph, std::size_t from, std::size_t to, const TPose2D& move) {
  const std::size_t later = std::max(from, to);
  const TPose2D& now = graph.pose(later);
  const TPose2D wanted(now.x + move.x, now.y + move.y, now.phi + move.phi);
  Constraint loop;
  loop.from = from;
  loop.to = to;
  loop.from_T_to = later == to ? between(graph.pose(from), wanted) : between(wanted, graph.pose(to));
  loop.kind = Constraint::Kind::kLoop;
  const std::size_t index = graph.add_constraint(loop);
  graph.set_enabled(index, false);
  return index;
}

TEST(AgreeingLoops, are_those_that_move_the_later_node_alike) {
  PoseGraph graph = straight_path();
  const std::vector<std::size_t> loops = {
      add_moving_loop(graph, 0, 30, {3.2, -1.1, 0.3}),  add_moving_loop(graph, 2, 33, {-4, 1, 0}),
      add_moving_loop(graph, 35, 1, {3.3, -1.2, 0.28}), add_moving_loop(graph, 5, 31, {3.2, -1.1, -0.5}),
      add_moving_loop(graph, 3, 36, {3.1, -1.0, 0.31}), add_moving_loop(graph, 4, 32, {3.2, 2.5, 0.3})};
  EXPECT_EQ(agreeing_loops(graph, loops), (std::vector<std::size_t>{0, 2, 4}));
}

TEST(AgreeingLoops, may_lie_on_both_sides_of_a_limit) {
  PoseGraph graph = straight_path();
  const double limit_m = 1.25;  // between two cells of moves
  const std::vector<std::size_t> loops = {add_moving_loop(graph, 0, 30, {limit_m - 0.01, 0, 0}),
                                          add_moving_loop(graph, 0, 31, {limit_m + 0.01, 0, 0}),
                                          add_moving_loop(graph, 0, 32, {limit_m + 5, 0, 0})};
  EXPECT_EQ(agreeing_loops(graph, loops), (std::vector<std::size_t>{0, 1}));
}

TEST(AgreeingLoops, may_turn_by_half_a_turn_to_either_side) {
  PoseGraph graph = straight_path();
  const std::vector<std::size_t> loops = {add_moving_loop(graph, 0, 30, {3, 0, 3.13}),
                                          add_moving_loop(graph, 0, 31, {3, 0, -3.13}),
                                          add_moving_loop(graph, 0, 32, {3, 0, 0})};
  EXPECT_EQ(agreeing_loops(graph, loops), (std::vector<std::size_t>{0, 1}));
}

TEST(AgreeingLoops, leave_out_loops_that_nearly_fit) {
  PoseGraph graph = straight_path();
  std::vector<std::size_t> loops = {add_moving_loop(graph, 0, 30, {2, 0, 0})};
  for (const double off_m : {0.3, -0.3, 0.6})
    loops.push_back(add_moving_loop(graph, 0, 31, {off_m, off_m, 0.1 * off_m}));
  EXPECT_EQ(agreeing_loops(graph, loops), std::vector<std::size_t>{0});
}

TEST(AgreeingLoops, are_disabled) {
  PoseGraph graph = straight_path();
  const std::vector<std::size_t> loops = {add_moving_loop(graph, 0, 30, {1, 0, 0}),
                                          add_moving_loop(graph, 0, 31, {1, 0, 0})};
  graph.set_enabled(loops[0], true);
  EXPECT_EQ(agreeing_loops(graph, loops), std::vector<std::size_t>{1});
  graph.set_enabled(loops[1], true);
  EXPECT_TRUE(agreeing_loops(graph, loops).empty());
}

}  // namespace
}  // namespace psi_slam
