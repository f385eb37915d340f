// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/superseded_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Numbers = std::vector<std::size_t>;

constexpr double kMinTravel_m = 10;
constexpr std::size_t kNodesOfRound = 40;
constexpr std::size_t kNodesOfMap = 10;

// A robot that drives round a circle of 20 m. There is a node every half metre, and a local map every ten
// nodes, which shares its last node with the next one.
struct Rounds {
  KeyframeStore keyframes = make_keyframe_store();
  PoseGraph graph;

  // With loops, a node of each local map is tied to the same place of the round before.
  void drive(std::size_t rounds, double radius_m = 20 / (2 * M_PI), bool with_loops = true) {
    for (std::size_t i = 0; i < rounds * kNodesOfRound; ++i) {
      const double angle = 2 * M_PI * static_cast<double>(i) / kNodesOfRound;
      NodeScan node;
      node.local_T_robot = {radius_m * std::cos(angle), radius_m * std::sin(angle), angle + M_PI / 2};
      node.travelled_m = 0.5 * static_cast<double>(keyframes.nodes.size());
      node.points = std::make_shared<ScanPoints>();
      keyframes.nodes.push_back(node);
      const std::size_t number = graph.add_node(node.local_T_robot);
      if (with_loops && number >= kNodesOfRound && number % kNodesOfMap == 5)
        tie(number - kNodesOfRound, number);
      if (number % kNodesOfMap == 0 && number > 0) {
        PlacedLocalMap map;
        map.id = keyframes.local_maps.size();
        map.first_node = map.anchor = number - kNodesOfMap;
        map.last_node = number;
        map.map = std::make_shared<LocalMap>(LocalMapOptions());
        remember_local_map(map, keyframes);
      }
    }
  }

  void tie(std::size_t from, std::size_t to) {
    Constraint loop;
    loop.from = from;
    loop.to = to;
    loop.kind = Constraint::Kind::kLoop;
    graph.add_constraint(loop);
  }

  Numbers superseded() const { return superseded_maps(keyframes, graph, kMinTravel_m); }
};

Numbers from_to(std::size_t begin, std::size_t end) {
  Numbers numbers;
  for (std::size_t i = begin; i < end; ++i) numbers.push_back(i);
  return numbers;
}

TEST(SupersededMaps, are_those_that_the_robot_passed_often_enough_since) {
  Rounds robot;
  robot.drive(kLaterPasses);
  EXPECT_EQ(robot.superseded(), Numbers());
  robot.drive(1);
  // The last local map ends at the end of the round before the last node, so the last place is not passed
  // yet.
  const Numbers found = robot.superseded();
  ASSERT_GE(found.size(), 2U);
  ASSERT_LT(found.size(), kNodesOfRound / kNodesOfMap);
  EXPECT_EQ(found, from_to(1, 1 + found.size())) << "the oldest round only, without the root of the graph";
}

TEST(SupersededMaps, need_loops_that_tie_the_later_passes) {
  Rounds robot;
  robot.drive(10, 20 / (2 * M_PI), false);
  EXPECT_EQ(robot.superseded(), Numbers()) << "the poses of later passes may be wrong";
  Rounds tied;
  tied.drive(10);
  EXPECT_FALSE(tied.superseded().empty());
  for (std::size_t i = 0; i < tied.graph.num_constraints(); ++i) tied.graph.set_enabled(i, false);
  EXPECT_EQ(tied.superseded(), Numbers()) << "rejected loops tie nothing";
}

TEST(SupersededMaps, are_at_the_same_place_and_in_the_same_direction) {
  Rounds elsewhere;
  elsewhere.drive(1);
  elsewhere.drive(kLaterPasses + 2, 20 / (2 * M_PI) + 1.5);
  ASSERT_FALSE(elsewhere.superseded().empty());
  for (const std::size_t map : elsewhere.superseded())
    EXPECT_GE(elsewhere.keyframes.local_maps[map].first_node, kNodesOfRound - kNodesOfMap);

  Rounds back;
  back.drive(1);
  const std::size_t maps = back.keyframes.local_maps.size();
  back.drive(kLaterPasses + 2);
  for (std::size_t node = kNodesOfRound; node < back.graph.num_nodes(); ++node) {
    TPose2D turned = back.graph.pose(node);
    turned.phi += M_PI;
    back.graph.set_pose(node, turned);
  }
  ASSERT_FALSE(back.superseded().empty());
  for (const std::size_t map : back.superseded()) EXPECT_GE(map, maps) << "a laser may see other walls";
}

TEST(SupersededMaps, are_not_superseded_by_a_robot_that_moves_about_in_one_place) {
  Rounds robot;
  robot.drive(10, 0.2);
  for (NodeScan& node : robot.keyframes.nodes) node.travelled_m /= 20;  // ten metres in all
  EXPECT_EQ(robot.superseded(), Numbers());
}

TEST(SupersededMaps, of_a_run_at_an_unknown_place_stay) {
  Rounds robot;
  robot.keyframes.unplaced.push_back({0, 2 * kNodesOfRound});
  robot.drive(kLaterPasses + 5);
  const Numbers found = robot.superseded();
  ASSERT_FALSE(found.empty());
  for (const std::size_t map : found)
    EXPECT_GE(robot.keyframes.local_maps[map].first_node, 2 * kNodesOfRound);
}

TEST(SupersededMaps, lose_their_memory_with_the_scans_that_no_other_map_holds) {
  Rounds robot;
  robot.drive(kLaterPasses + 2);
  const Numbers nodes = drop_local_maps({0, 2}, robot.keyframes);
  EXPECT_EQ(robot.keyframes.local_maps[0].map, nullptr);
  EXPECT_NE(robot.keyframes.local_maps[1].map, nullptr);
  // Node 10 is in the local maps 0 and 1, node 20 in 1 and 2, and node 30 in 2 and 3.
  Numbers expected = from_to(0, 10);
  for (std::size_t node = 21; node < 30; ++node) expected.push_back(node);
  EXPECT_EQ(nodes, expected);
  for (std::size_t node = 0; node < robot.keyframes.nodes.size(); ++node)
    EXPECT_EQ(robot.keyframes.nodes[node].points == nullptr,
              std::count(expected.begin(), expected.end(), node) == 1)
        << node;
  EXPECT_EQ(drop_local_maps({1}, robot.keyframes), from_to(10, 21));
  for (const std::size_t map : robot.superseded()) EXPECT_GT(map, 2U) << "each map is named once";
  WorkerPool pool(1);
  unpack_local_maps(robot.keyframes, {0, 1, 2, 3}, pool);  // dropped maps are ignored
}

}  // namespace
}  // namespace psi_slam
