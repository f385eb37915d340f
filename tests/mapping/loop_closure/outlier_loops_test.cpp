// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/outlier_loops.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/degrees.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "pose_graph/graduated_non_convexity.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

Constraint measured(Constraint::Kind kind, std::size_t from, std::size_t to, const TPose2D& from_T_to,
                    double sigma_m, double sigma_rad) {
  Constraint constraint;
  constraint.kind = kind;
  constraint.from = from;
  constraint.to = to;
  constraint.from_T_to = from_T_to;
  constraint.information =
      Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
          .asDiagonal();
  return constraint;
}

// A straight chain of nodes, one metre apart. Each constraint of the path has standard deviations of 0.1 m
// and 0.01 rad, divided by `certainty`; with its doubt, all have 0.1 m and 0.01 rad.
PoseGraph straight_chain(std::size_t nodes, double certainty = 1) {
  PoseGraph graph;
  for (std::size_t i = 0; i < nodes; ++i) {
    graph.add_node({static_cast<double>(i), 0, 0});
    if (i == 0) continue;
    Constraint step =
        measured(Constraint::Kind::kLocalMap, i - 1, i, {1, 0, 0}, 0.1 / certainty, 0.01 / certainty);
    step.doubt = (certainty * certainty - 1) * Eigen::Matrix3d(step.information.inverse());
    graph.add_constraint(step);
  }
  return graph;
}

// Adds a loop from the first node of a straight chain, with standard deviations of 0.02 m and 0.01 rad, and
// with these errors along and across the path.
std::size_t add_loop(PoseGraph& graph, std::size_t to, double along_m, double across_m) {
  return graph.add_constraint(
      measured(Constraint::Kind::kLoop, 0, to, {static_cast<double>(to) + along_m, across_m, 0}, 0.02, 0.01));
}

std::size_t add_bent_loop(PoseGraph& graph, std::size_t to, double across_m) {
  return add_loop(graph, to, 0, across_m);
}

SparsePoseAdjustment plain_solver() {
  PoseAdjustmentOptions options;
  options.loop_kernel = {};
  return SparsePoseAdjustment(options);
}

// Rejects outlier loops, and checks what reject_outlier_loops() promises of the residuals.
std::vector<double> reject(PoseGraph& graph, const std::vector<std::size_t>& loops) {
  SparsePoseAdjustment solver = plain_solver();
  std::vector<double> chi = reject_outlier_loops(graph, solver, loops);
  EXPECT_EQ(chi.size(), loops.size());
  PoseGraph again = graph;
  const std::vector<ConstraintFit> fits = solver.optimize(again).fits;
  for (std::size_t i = 0; i < loops.size(); ++i)
    EXPECT_NEAR(chi[i], std::sqrt(fits[loops[i]].chi2), 1e-3 * (1 + chi[i]))
        << "residual in the graph, loop " << i;
  return chi;
}

TEST(OutlierLoops, keeps_consistent_loops) {
  PoseGraph graph = straight_chain(20);
  const std::vector<std::size_t> loops = {add_bent_loop(graph, 12, 0.01), add_bent_loop(graph, 19, -0.01)};
  const std::vector<double> chi = reject(graph, loops);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_TRUE(graph.enabled(loops[i]));
    EXPECT_LT(chi[i], 1);
  }
}

TEST(OutlierLoops, keeps_true_loops_near_a_false_one) {
  PoseGraph graph = straight_chain(20);
  std::vector<std::size_t> loops;
  for (const std::size_t to : {17U, 17U, 17U, 18U, 19U}) loops.push_back(add_bent_loop(graph, to, 0));
  loops.insert(loops.begin() + 2, add_bent_loop(graph, 17, 8));

  PoseGraph bent = graph;
  SparsePoseAdjustment solver = plain_solver();
  const std::vector<ConstraintFit> fits = solver.optimize(bent).fits;
  EXPECT_GT(fits[loops[0]].chi2, kInlierChi * kInlierChi)
      << "after one optimisation, true loops have large residuals too";

  const std::vector<double> chi = reject(graph, loops);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_EQ(graph.enabled(loops[i]), i != 2) << i;
    if (i == 2)
      EXPECT_NEAR(chi[i], 8 / 0.02, 1) << "residual in the graph without the loop";
    else
      EXPECT_LT(chi[i], 0.1) << i;
  }
  EXPECT_NEAR(graph.pose(17).y, 0, 1e-3);
}

TEST(OutlierLoops, disables_false_loops_of_all_sizes) {
  PoseGraph graph = straight_chain(20);
  std::vector<std::size_t> loops;
  for (std::size_t to = 10; to < 20; ++to) loops.push_back(add_bent_loop(graph, to, 0));
  const std::vector<std::size_t> wrong = {add_bent_loop(graph, 11, 20), add_bent_loop(graph, 14, 2),
                                          add_bent_loop(graph, 18, -0.5)};
  loops.insert(loops.end(), wrong.begin(), wrong.end());
  reject(graph, loops);
  for (std::size_t i = 0; i < loops.size(); ++i) EXPECT_EQ(graph.enabled(loops[i]), i < 10) << i;
}

TEST(OutlierLoops, enables_disabled_loops_that_fit) {
  PoseGraph graph = straight_chain(20);
  const std::vector<std::size_t> loops = {add_bent_loop(graph, 15, 0.01), add_bent_loop(graph, 19, 0.0),
                                          add_bent_loop(graph, 15, 5)};
  for (const std::size_t loop : loops) graph.set_enabled(loop, false);
  reject(graph, loops);
  EXPECT_TRUE(graph.enabled(loops[0]));
  EXPECT_TRUE(graph.enabled(loops[1]));
  EXPECT_FALSE(graph.enabled(loops[2]));
}

TEST(OutlierLoops, finds_few_true_loops_among_many_scattered_false_ones) {
  PoseGraph graph = straight_chain(10);
  std::vector<std::size_t> loops;
  for (const std::size_t to : {7U, 8U, 9U}) loops.push_back(add_loop(graph, to, 0.01, 0));
  for (std::size_t i = 0; i < 15; ++i)
    loops.push_back(add_loop(graph, 3 + i % 7, 4 + 3 * static_cast<double>(i), -5));
  reject(graph, loops);
  for (std::size_t i = 0; i < loops.size(); ++i) EXPECT_EQ(graph.enabled(loops[i]), i < 3) << i;
  EXPECT_NEAR(graph.pose(9).x, 9.01, 0.01);
  EXPECT_NEAR(graph.pose(9).y, 0, 0.01);
}

// Also the doubtful path contradicts each group, although the largest group outnumbers the true loops.
TEST(OutlierLoops, rejects_groups_of_false_loops_that_the_path_contradicts) {
  PoseGraph graph = straight_chain(10, kPathDoubt);
  std::vector<std::size_t> loops;
  for (const std::size_t to : {7U, 8U, 9U}) loops.push_back(add_loop(graph, to, 0.01, 0));
  for (std::size_t i = 0; i < 30; ++i)  // five groups of false loops, each consistent in itself
    loops.push_back(add_loop(graph, 3 + i % 6, 6 + 4 * static_cast<double>(i / 6), -8));
  const std::vector<double> chi = reject(graph, loops);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_EQ(graph.enabled(loops[i]), i < 3) << i;
    EXPECT_EQ(chi[i] <= kInlierChi, i < 3) << i;
  }
}

// A long chain whose path does not tell which of two sets of loops to its last nodes is true. The loops of
// the smaller set lead 3 m aside.
TEST(OutlierLoops, the_majority_decides_between_sets_that_the_path_allows) {
  for (const std::size_t fewer : {5U, 20U}) {
    SCOPED_TRACE(fewer);
    constexpr std::size_t kMore = 30;
    PoseGraph graph = straight_chain(80);
    std::vector<std::size_t> loops;
    for (std::size_t i = 0; i < kMore; ++i) loops.push_back(add_bent_loop(graph, 79 - i, 0));
    for (std::size_t i = 0; i < fewer; ++i) loops.push_back(add_bent_loop(graph, 79 - i, 3));
    for (std::size_t i = 0; i < kMore; ++i) graph.set_enabled(loops[i], false);
    const std::vector<double> chi = reject(graph, loops);
    for (std::size_t i = 0; i < loops.size(); ++i) EXPECT_EQ(graph.enabled(loops[i]), i < kMore) << i;
    EXPECT_NEAR(graph.pose(77).y, 0, 1e-3);
    EXPECT_NEAR(chi.back(), 3 / 0.02, 1) << "residual in the graph that was chosen";
  }
}

TEST(OutlierLoops, ignores_which_loops_were_enabled) {
  PoseGraph graph = straight_chain(10);
  const std::vector<std::size_t> loops{add_loop(graph, 9, 0.02, 0), add_loop(graph, 8, 30, 0),
                                       add_loop(graph, 7, 0, 0)};
  PoseGraph other = graph;
  other.set_enabled(loops[0], false);
  other.set_enabled(loops[1], false);
  reject(graph, loops);
  reject(other, loops);
  for (const std::size_t loop : loops) EXPECT_EQ(graph.enabled(loop), other.enabled(loop));
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(graph.pose(i), other.pose(i));
}

// Without a contradicted loop, nothing is rejected, whatever the kernel would do.
TEST(OutlierLoops, rejects_loops_only_beyond_the_limit) {
  PoseGraph graph = straight_chain(20);
  const std::size_t probe = add_bent_loop(graph, 1, 0.3);
  add_bent_loop(graph, 1, 0);
  PoseGraph copy = graph;
  SparsePoseAdjustment solver = plain_solver();
  const double chi = std::sqrt(solver.optimize(copy).fits[probe].chi2);
  for (const double of_limit : {0.999, 1.001}) {
    PoseGraph chain = straight_chain(20);
    const std::vector<std::size_t> loops = {add_bent_loop(chain, 1, 0.3 * of_limit * kInlierChi / chi),
                                            add_bent_loop(chain, 1, 0)};
    reject(chain, loops);
    EXPECT_EQ(chain.enabled(loops[0]) && chain.enabled(loops[1]), of_limit < 1);
  }
}

// A forced loop has a kernel of its own, and is not among the loops that are judged.
TEST(OutlierLoops, a_loop_with_its_own_kernel_holds_against_path_and_loops) {
  PoseGraph graph = straight_chain(20);
  const std::size_t forced = add_bent_loop(graph, 19, 3);
  std::vector<std::size_t> loops;
  for (const std::size_t to : {17U, 18U, 19U}) loops.push_back(add_bent_loop(graph, to, 0));

  PoseGraph without_force = graph;
  std::vector<std::size_t> all = loops;
  all.push_back(forced);
  reject(without_force, all);
  EXPECT_FALSE(without_force.enabled(forced)) << "three loops outvote it if it is not forced";

  Constraint loop = graph.constraint(forced);
  loop.kernel = RobustKernel{};
  PoseGraph with_force = straight_chain(20);
  ASSERT_EQ(with_force.add_constraint(loop), forced);
  for (const std::size_t other : loops) with_force.add_constraint(graph.constraint(other));
  reject(with_force, loops);
  EXPECT_TRUE(with_force.enabled(forced));
  for (const std::size_t other : loops) EXPECT_FALSE(with_force.enabled(other)) << other;
  EXPECT_NEAR(with_force.pose(19).y, 3, 0.05);
}

// Three rounds along one way of 20 m, forth and back, with loops to the first round. If `is_bent`, the path
// of the later rounds turns by half a degree in every second group of five steps. The path states a heading
// error of `sigma_rad` per step. False loops lead anywhere.
struct BentRounds {
  BentRounds(std::size_t true_loops, std::size_t false_loops, bool is_bent, double sigma_rad) {
    constexpr std::size_t kNodes = 120;
    const auto truth = [](std::size_t node) {
      const std::size_t step = node % 40;
      return TPose2D(static_cast<double>(step < 20 ? step : 40 - step), 0, 0);
    };
    for (std::size_t node = 0; node < kNodes; ++node) {
      graph.add_node(truth(node));
      if (node == 0) continue;
      const TPose2D motion = truth(node) - truth(node - 1);
      const bool bends = is_bent && node > 40 && node % 10 < 5;
      graph.add_constraint(measured(Constraint::Kind::kLocalMap, node - 1, node,
                                    {motion.x, motion.y, bends ? kBend_rad : 0}, 0.01, sigma_rad));
    }
    for (std::size_t node = 1; node < kNodes; ++node)  // along the bent path
      graph.set_pose(node, graph.pose(node - 1) + graph.constraint(node - 1).from_T_to);
    for (std::size_t i = 0; i < true_loops; ++i) {
      const std::size_t node = 41 + i * 79 / true_loops;
      loops.push_back(
          graph.add_constraint(measured(Constraint::Kind::kLoop, node % 40, node, {0, 0, 0}, 0.02, 5e-3)));
    }
    for (std::size_t i = 0; i < false_loops; ++i) {
      const auto a = static_cast<double>(i);
      loops.push_back(graph.add_constraint(
          measured(Constraint::Kind::kLoop, i % 40, 41 + i * 37 % 79,
                   {4 * std::sin(7 * a), 4 * std::sin(11 * a), std::sin(5 * a)}, 0.02, 5e-3)));
    }
    reject(graph, loops);
    for (std::size_t i = 0; i < loops.size(); ++i)
      (i < true_loops ? true_on : false_on) += graph.enabled(loops[i]) ? 1 : 0;
    for (std::size_t node = 0; node < kNodes; ++node)
      worst_m = std::max(worst_m, (graph.pose(node) - truth(node)).norm());
  }

  static constexpr double kBend_rad = radians_from_degrees(0.5L);

  PoseGraph graph;
  std::vector<std::size_t> loops;
  std::size_t true_on = 0;
  std::size_t false_on = 0;
  double worst_m = 0;
};

TEST(OutlierLoops, agreeing_loops_bend_a_path_that_states_its_error) {
  for (const std::size_t true_loops : {5U, 70U}) {
    BentRounds bent(true_loops, 0, true, BentRounds::kBend_rad);
    EXPECT_EQ(bent.true_on, true_loops);
    EXPECT_LT(bent.worst_m, true_loops < 70 ? 1 : 0.1) << true_loops;
    reject(bent.graph, bent.loops);
    for (const std::size_t loop : bent.loops) EXPECT_TRUE(bent.graph.enabled(loop)) << "called again";
  }
}

TEST(OutlierLoops, agreeing_loops_bend_a_path_among_false_loops) {
  for (const std::size_t false_loops : {20U, 70U}) {
    const BentRounds mixed(70, false_loops, true, BentRounds::kBend_rad);
    EXPECT_EQ(mixed.true_on, 70U) << false_loops;
    EXPECT_EQ(mixed.false_on, 0U) << false_loops;
    EXPECT_LT(mixed.worst_m, 0.1) << false_loops;
  }
}

TEST(OutlierLoops, false_loops_do_not_bend_a_straight_path) {
  for (const std::size_t false_loops : {30U, 70U, 300U}) {
    const BentRounds straight(70, false_loops, false, 1e-3);
    EXPECT_EQ(straight.true_on, 70U) << false_loops;
    EXPECT_EQ(straight.false_on, 0U) << false_loops;
    EXPECT_LT(straight.worst_m, 0.02) << false_loops;
  }
}

// Errors that repeat along the whole path are no reason to reject loops that agree, and a loop that is a
// little off the bent path is rejected.
TEST(OutlierLoops, a_path_that_bends_everywhere_yields_and_then_judges_small_errors) {
  PoseGraph graph = straight_chain(40, kPathDoubt);
  const double bend_rad = 0.006;  // per metre, three times what the path states
  const auto bent = [&](std::size_t to) {
    TPose2D pose;
    for (std::size_t i = 0; i < to; ++i) pose = pose + TPose2D(1, 0, bend_rad);
    return pose;
  };
  std::vector<std::size_t> loops;
  for (std::size_t to = 20; to < 40; ++to)
    loops.push_back(graph.add_constraint(measured(Constraint::Kind::kLoop, 0, to, bent(to), 0.02, 0.01)));
  const std::size_t off = graph.add_constraint(
      measured(Constraint::Kind::kLoop, 0, 30, bent(30) + TPose2D(0.2, 0, 0), 0.02, 0.01));
  loops.push_back(off);
  reject(graph, loops);
  for (const std::size_t loop : loops) EXPECT_EQ(graph.enabled(loop), loop != off);
  EXPECT_NEAR(graph.pose(39).y, bent(39).y, 0.05);
}

TEST(OutlierLoops, a_constraint_is_contradicted_in_standard_deviations_of_it_and_the_path) {
  PoseGraph graph = straight_chain(10);
  const std::size_t loop = add_loop(graph, 9, 3, 0);
  graph.set_enabled(loop, false);
  const double variance_m2 = 9 * 0.1 * 0.1 + 0.02 * 0.02;
  EXPECT_NEAR(contradiction(graph.constraint(loop), graph).value(), 3 / std::sqrt(variance_m2), 1e-6);
  EXPECT_NEAR(contradiction(graph.constraint(add_loop(graph, 9, 0, 0)), graph).value(), 0, 1e-9);
}

TEST(OutlierLoops, a_graph_without_loops_is_optimised) {
  PoseGraph graph = straight_chain(20);
  graph.set_pose(19, {25, 3, 1});
  SparsePoseAdjustment solver = plain_solver();
  EXPECT_TRUE(reject_outlier_loops(graph, solver, {}).empty());
  EXPECT_NEAR(graph.pose(19).x, 19, 1e-6);
}

}  // namespace
}  // namespace psi_slam
