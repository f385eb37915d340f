// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/node_star.h"

#include <gtest/gtest.h>

#include "dense_reference.h"

namespace psi_slam {
namespace {

constexpr std::uint32_t kCentre = 4;

/// The root, three core nodes linked with each other, and the centre linked with all of them in both
/// directions and twice with node 1.
PoseGraph small_graph(std::uint64_t seed) {
  Measurer measurer(seed);
  const std::vector<TPose2D> truth{{0, 0, 0}, {1, 0, 0.4}, {2, 1, -0.8}, {1, 3, 2.5}, {3, 3, 3.1}};
  PoseGraph graph;
  for (const TPose2D& pose : truth)
    graph.add_node(
        compose(pose, {0.1 * measurer.normal(), 0.1 * measurer.normal(), 0.1 * measurer.normal()}));
  for (const auto& [from, to] : std::vector<std::pair<std::size_t, std::size_t>>{
           {0, 1}, {1, 2}, {2, 3}, {3, 1}, {0, 4}, {1, 4}, {4, 2}, {3, 4}, {1, 4}})
    graph.add_constraint(measurer.measure(truth, from, to, Constraint::Kind::kLocalMap, 0.1, 0.05));
  return graph;
}

/// The equations of small_graph() with stars at the nodes 2, 3 and 4, linearised at the graph's poses.
struct Stars {
  Stars(const PoseGraph& of, bool eliminate_centre) : graph(of) {
    variable_of.assign(graph.num_nodes(), NodeStar::kNoVariable);
    for (std::uint32_t node = 1; node < graph.num_nodes(); ++node)
      if (node != kCentre || !eliminate_centre) variable_of[node] = equations.add_variable();
    for (std::uint32_t node = 0; node < graph.num_nodes(); ++node) stars.emplace_back(node);
    for (std::uint32_t i = 0; i < graph.num_constraints(); ++i) {
      stars[std::max(graph.constraint(i).from, graph.constraint(i).to)].add(graph, i);
    }
    const std::vector<RotatedPose> poses = rotated(graph.poses());
    for (std::uint32_t node = 1; node < graph.num_nodes(); ++node) {
      EXPECT_TRUE(stars[node].linearize(graph, poses, {}, variable_of[node] == NodeStar::kNoVariable));
      stars[node].link(variable_of, equations);
    }
    equations.lay_out();
  }

  void add(double sign, const std::vector<RotatedPose>& poses) {
    for (std::uint32_t node = 1; node < stars.size(); ++node)
      stars[node].add_to(equations, sign, graph, poses, variable_of);
  }

  const PoseGraph& graph;
  std::vector<NodeStar> stars;
  std::vector<std::uint32_t> variable_of;
  CondensedEquations equations;
};

/// Largest difference between the steps from `start` and a dense solution of the equations linearised at the
/// poses of the graph.
double difference_from_dense(const PoseGraph& graph, bool eliminate_centre, const PoseGraph& start) {
  Stars stars(graph, eliminate_centre);
  std::vector<RotatedPose> poses = rotated(start.poses());
  stars.add(1, poses);
  EXPECT_TRUE(stars.equations.solve());
  const DenseSystem system = held_at_root(dense_system(graph));
  PoseGraph expected = graph;
  move_all(expected, system.h.ldlt().solve(-system.g));
  for (std::uint32_t node = 1; node < poses.size(); ++node) {
    if (stars.variable_of[node] == NodeStar::kNoVariable) continue;
    const Eigen::Vector3d step = stars.equations.step(stars.variable_of[node]);
    poses[node] =
        RotatedPose({poses[node].x + step.x(), poses[node].y + step.y(), poses[node].theta + step.z()});
  }
  if (eliminate_centre) poses[kCentre] = stars.stars[kCentre].centre_pose(poses);
  double largest = 0;
  for (std::size_t node = 0; node < poses.size(); ++node)
    largest = std::max({largest, std::abs(poses[node].x - expected.pose(node).x),
                        std::abs(poses[node].y - expected.pose(node).y),
                        std::abs(wrap_to_pi(poses[node].theta - expected.pose(node).phi))});
  return largest;
}

TEST(NodeStar, gives_the_steps_of_the_dense_equations) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PoseGraph graph = small_graph(seed);
    EXPECT_LT(difference_from_dense(graph, false, graph), 1e-6);
    EXPECT_LT(difference_from_dense(graph, true, graph), 1e-6);
  }
}

TEST(NodeStar, keeps_its_linearisation_when_the_nodes_move) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PoseGraph graph = small_graph(seed);
    PoseGraph moved = graph;
    Measurer measurer(seed);
    for (std::size_t node = 1; node < graph.num_nodes(); ++node)
      moved.set_pose(node, compose(graph.pose(node), {0.2 * measurer.normal(), 0.2 * measurer.normal(),
                                                      0.2 * measurer.normal()}));
    EXPECT_LT(difference_from_dense(graph, false, moved), 1e-6);
    EXPECT_LT(difference_from_dense(graph, true, moved), 1e-6);
  }
}

TEST(NodeStar, subtracts_what_it_has_added) {
  const PoseGraph graph = small_graph(6);
  const std::vector<RotatedPose> poses = rotated(graph.poses());
  for (const bool eliminate : {false, true}) {
    Stars stars(graph, eliminate);
    stars.add(1, poses);
    stars.equations.solve();
    const Eigen::Vector3d once = stars.equations.step(1);
    Stars again(graph, eliminate);
    again.add(1, poses);
    again.add(-1, poses);
    again.add(1, poses);
    again.equations.solve();
    EXPECT_LT((again.equations.step(1) - once).norm(), 1e-12);
  }
}

TEST(NodeStar, predicts_the_decrease_when_its_centre_moves) {
  const PoseGraph graph = small_graph(7);
  Stars stars(graph, true);
  std::vector<RotatedPose> poses = rotated(graph.poses());
  const NodeStar& star = stars.stars[kCentre];
  const double before = star.fit(graph, poses, {}).cost;
  poses[kCentre] = star.centre_pose(poses);
  const double after = star.fit(graph, poses, {}).cost;
  EXPECT_NEAR(before - after, star.decrease_by_elimination(), 0.1 * before);
  EXPECT_LT(after, before);
}

TEST(NodeStar, gives_the_heading_of_a_centre_where_a_constraint_begins) {
  const PoseGraph graph = small_graph(8);
  const std::vector<RotatedPose> poses = rotated(graph.poses());
  for (const std::uint32_t constraint : {4U, 6U}) {  // 0 -> 4 and 4 -> 2
    NodeStar star(4);
    star.add(graph, constraint);
    ASSERT_TRUE(star.linearize(graph, poses, {}, true));
    const RotatedPose pose = star.centre_pose(poses);
    const RotatedPose expected({pose.x, pose.y, pose.theta});
    EXPECT_EQ(pose.sine == expected.sine && pose.cosine == expected.cosine, constraint == 6);
  }
}

TEST(NodeStar, notices_when_its_linearisation_no_longer_holds) {
  KnownGraph known = ring(20, 0, 1);
  NodeStar star(1);
  star.add(known.graph, 0);
  star.add(known.graph, 1);
  std::vector<RotatedPose> poses = rotated(known.graph.poses());
  ASSERT_TRUE(star.linearize(known.graph, poses, {}, true));
  EXPECT_TRUE(star.fit(known.graph, poses, {}).is_linear);
  const RotatedPose before = poses[1];
  poses[1].x += 1;
  EXPECT_TRUE(star.fit(known.graph, poses, {}).is_linear) << "positions are linear";
  poses[1] = RotatedPose({before.x, before.y, before.theta + 0.1});
  EXPECT_FALSE(star.fit(known.graph, poses, {}).is_linear);
}

TEST(NodeStar, notices_when_a_weight_changes) {
  KnownGraph known = ring(20, 1, 0);
  const auto loop = static_cast<std::uint32_t>(known.graph.num_constraints() - 1);
  const auto centre = static_cast<std::uint32_t>(known.graph.constraint(loop).to);
  NodeStar star(centre);
  star.add(known.graph, loop);
  std::vector<RotatedPose> poses = rotated(known.graph.poses());
  ASSERT_TRUE(star.linearize(known.graph, poses, {}, true));
  poses[centre].x += 0.02;  // two standard deviations; the kernel has a width of three
  EXPECT_TRUE(star.fit(known.graph, poses, {}).is_linear);
  poses[centre].x += 0.02;
  EXPECT_FALSE(star.fit(known.graph, poses, {}).is_linear);
}

TEST(NodeStar, does_not_eliminate_an_undetermined_centre) {
  KnownGraph known = ring(3, 0, 0);
  PoseGraph graph;
  for (const TPose2D& pose : known.graph.poses()) graph.add_node(pose);
  Constraint constraint = known.graph.constraint(0);
  constraint.information(2, 2) = 0;
  graph.add_constraint(constraint);
  NodeStar star(1);
  star.add(graph, 0);
  EXPECT_FALSE(star.linearize(graph, rotated(graph.poses()), {}, true));
  EXPECT_TRUE(star.linearize(graph, rotated(graph.poses()), {}, false));
}

}  // namespace
}  // namespace psi_slam
