// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/outlier_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kOutlierChi = 5;

// A chain of twenty nodes, one metre apart. Each constraint of odometry has a standard deviation of 0.1 m.
PoseGraph odometry_chain() {
  PoseGraph graph;
  for (std::size_t i = 0; i < 20; ++i) {
    graph.add_node({static_cast<double>(i), 0, 0});
    if (i == 0) continue;
    Constraint step;
    step.from = i - 1;
    step.to = i;
    step.from_T_to = {1, 0, 0};
    step.information = Eigen::Vector3d(100, 100, 1e4).asDiagonal();
    graph.add_constraint(step);
  }
  return graph;
}

// Adds a loop from the first node, with a standard deviation of 0.02 m and an error of `off_m` across the
// path.
std::size_t add_bent_loop(PoseGraph& graph, std::size_t to, double off_m) {
  Constraint loop;
  loop.to = to;
  loop.from_T_to = {static_cast<double>(to), off_m, 0};
  loop.information = Eigen::Vector3d(2500, 2500, 1e4).asDiagonal();
  loop.kind = Constraint::Kind::kLoop;
  return graph.add_constraint(loop);
}

SparsePoseAdjustment plain_solver() {
  PoseAdjustmentOptions options;
  options.loop_kernel = {};
  return SparsePoseAdjustment(options);
}

TEST(OutlierLoops, keeps_consistent_loops) {
  PoseGraph graph = odometry_chain();
  const std::vector<std::size_t> loops = {add_bent_loop(graph, 12, 0.01), add_bent_loop(graph, 19, -0.01)};
  SparsePoseAdjustment solver = plain_solver();
  const std::vector<double> chi = switch_off_outlier_loops(graph, solver, loops, kOutlierChi);
  ASSERT_EQ(chi.size(), 2U);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_TRUE(graph.enabled(loops[i]));
    EXPECT_LT(chi[i], 1);
  }
}

TEST(OutlierLoops, keeps_true_loops_near_a_false_one) {
  PoseGraph graph = odometry_chain();
  std::vector<std::size_t> loops;
  for (const std::size_t to : {17U, 17U, 17U, 18U, 19U}) loops.push_back(add_bent_loop(graph, to, 0));
  loops.insert(loops.begin() + 2, add_bent_loop(graph, 17, 8));

  PoseGraph bent = graph;
  SparsePoseAdjustment solver = plain_solver();
  const std::vector<ConstraintFit> fits = solver.optimize(bent).fits;
  EXPECT_GT(fits[loops[0]].chi2, kOutlierChi * kOutlierChi)
      << "after one optimisation, true loops have large residuals too";

  const std::vector<double> chi = switch_off_outlier_loops(graph, solver, loops, kOutlierChi);
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
  PoseGraph graph = odometry_chain();
  std::vector<std::size_t> loops;
  for (std::size_t to = 10; to < 20; ++to) loops.push_back(add_bent_loop(graph, to, 0));
  const std::vector<std::size_t> wrong = {add_bent_loop(graph, 11, 20), add_bent_loop(graph, 14, 2),
                                          add_bent_loop(graph, 18, -0.5)};
  loops.insert(loops.end(), wrong.begin(), wrong.end());
  SparsePoseAdjustment solver = plain_solver();
  switch_off_outlier_loops(graph, solver, loops, kOutlierChi);
  for (std::size_t i = 0; i < loops.size(); ++i) EXPECT_EQ(graph.enabled(loops[i]), i < 10) << i;
}

TEST(OutlierLoops, enables_loops_that_fit_in_the_end) {
  PoseGraph graph = odometry_chain();
  const std::vector<std::size_t> loops = {add_bent_loop(graph, 15, 0.01), add_bent_loop(graph, 19, 0.0),
                                          add_bent_loop(graph, 17, 5)};
  for (const std::size_t loop : loops) graph.set_enabled(loop, false);
  SparsePoseAdjustment solver = plain_solver();
  switch_off_outlier_loops(graph, solver, loops, kOutlierChi);
  EXPECT_TRUE(graph.enabled(loops[0]));
  EXPECT_TRUE(graph.enabled(loops[1]));
  EXPECT_FALSE(graph.enabled(loops[2]));
}

// A chain of 80 nodes with loops from the first node to the last ones: some that are right and off, and some
// that lead 3 m aside and are on.
struct TwoSets {
  TwoSets(std::size_t right, std::size_t wrong) {
    for (std::size_t i = 20; i < 80; ++i) {
      graph.add_node({static_cast<double>(i), 0, 0});
      Constraint step = graph.constraint(0);
      step.from = i - 1;
      step.to = i;
      graph.add_constraint(step);
    }
    for (std::size_t i = 0; i < right + wrong; ++i) {
      const bool is_right = i < right;
      loops.push_back(add_bent_loop(graph, 79 - (is_right ? i : i - right), is_right ? 0 : 3));
      graph.set_enabled(loops.back(), !is_right);
    }
    SparsePoseAdjustment solver = plain_solver();
    chi = switch_off_outlier_loops(graph, solver, loops, kOutlierChi);
  }

  PoseGraph graph = odometry_chain();
  std::vector<std::size_t> loops;
  std::vector<double> chi;
};

TEST(OutlierLoops, prefers_loops_of_many_nodes_that_agree_to_the_few_that_contradict_them) {
  const TwoSets sets(30, 5);
  for (std::size_t i = 0; i < 35; ++i) EXPECT_EQ(sets.graph.enabled(sets.loops[i]), i < 30) << i;
  EXPECT_NEAR(sets.graph.pose(77).y, 0, 1e-3);
  EXPECT_NEAR(sets.chi.back(), 3 / 0.02, 1) << "residual in the graph that was chosen";
}

TEST(OutlierLoops, does_not_prefer_loops_of_few_nodes) {
  const TwoSets sets(kFewestAgreeingNodes - 1, 5);
  for (const std::size_t loop : sets.loops)
    EXPECT_EQ(sets.graph.enabled(loop), loop >= sets.loops[kFewestAgreeingNodes - 1]);
}

TEST(OutlierLoops, keeps_what_nearly_as_many_loops_contradict) {
  const TwoSets sets(30, 20);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(sets.graph.enabled(sets.loops[i]), i >= 30) << i;
}

// Three rounds along one way of 20 m, forth and back, with loops to the first round. The path of the later
// rounds turns by half a degree in each of some steps, as certain as elsewhere. False loops lead anywhere.
struct BentRounds {
  BentRounds(std::size_t true_loops, std::size_t false_loops, bool is_bent,
             Constraint::Kind kind = Constraint::Kind::kOdometry) {
    constexpr std::size_t kNodes = 120;
    const auto truth = [](std::size_t node) {
      const std::size_t step = node % 40;
      return TPose2D(static_cast<double>(step < 20 ? step : 40 - step), 0, 0);
    };
    std::vector<TPose2D> motions;
    for (std::size_t node = 0; node < kNodes; ++node) {
      graph.add_node(truth(node));
      if (node == 0) continue;
      const TPose2D motion = truth(node) - truth(node - 1);
      const bool bends = is_bent && node > 40 && node % 10 < 5;
      graph.add_constraint(
          constraint(kind, node - 1, node, {motion.x, motion.y, bends ? 0.5 * M_PI / 180 : 0}, 0.01, 1e-3));
    }
    // Along the bent path.
    for (std::size_t node = 1; node < kNodes; ++node)
      graph.set_pose(node, graph.pose(node - 1) + graph.constraint(node - 1).from_T_to);
    for (std::size_t i = 0; i < true_loops; ++i) {
      const std::size_t node = 41 + i * 79 / true_loops;
      loops.push_back(
          graph.add_constraint(constraint(Constraint::Kind::kLoop, node % 40, node, {0, 0, 0}, 0.02, 5e-3)));
    }
    for (std::size_t i = 0; i < false_loops; ++i) {
      const auto a = static_cast<double>(i);
      loops.push_back(graph.add_constraint(
          constraint(Constraint::Kind::kLoop, i % 40, 41 + i * 37 % 79,
                     {4 * std::sin(7 * a), 4 * std::sin(11 * a), std::sin(5 * a)}, 0.02, 5e-3)));
    }
    SparsePoseAdjustment solver = plain_solver();
    chi = switch_off_outlier_loops(graph, solver, loops, kOutlierChi);
    for (std::size_t i = 0; i < loops.size(); ++i)
      (i < true_loops ? true_on : false_on) += graph.enabled(loops[i]) ? 1 : 0;
    for (std::size_t node = 0; node < kNodes; ++node)
      worst_m = std::max(worst_m, (graph.pose(node) - truth(node)).norm());
  }

  static Constraint constraint(Constraint::Kind kind, std::size_t from, std::size_t to,
                               const TPose2D& from_T_to, double sigma_m, double sigma_rad) {
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

  PoseGraph graph;
  std::vector<std::size_t> loops;
  std::vector<double> chi;
  std::size_t true_on = 0;
  std::size_t false_on = 0;
  double worst_m = 0;
};

TEST(OutlierLoops, keeps_the_loops_along_a_bent_path) {
  for (const Constraint::Kind kind : {Constraint::Kind::kOdometry, Constraint::Kind::kLocalMap}) {
    BentRounds bent(70, 0, true, kind);
    EXPECT_GE(bent.true_on, 68U);
    EXPECT_LT(bent.worst_m, 0.3);
    SparsePoseAdjustment solver = plain_solver();
    const std::vector<ConstraintFit> fits = solver.optimize(bent.graph).fits;
    for (std::size_t i = 0; i < bent.loops.size(); ++i)
      EXPECT_NEAR(bent.chi[i], std::sqrt(fits[bent.loops[i]].chi2), 1e-3)
          << "residual in the graph, loop " << i;
    switch_off_outlier_loops(bent.graph, solver, bent.loops, kOutlierChi);
    std::size_t on_again = 0;
    for (const std::size_t loop : bent.loops) on_again += bent.graph.enabled(loop) ? 1 : 0;
    EXPECT_EQ(on_again, bent.true_on) << "called again";
  }
}

TEST(OutlierLoops, few_loops_do_not_bend_a_path) {
  EXPECT_LT(BentRounds(kFewestAgreeingNodes - 1, 0, true).true_on, kFewestAgreeingNodes - 1);
}

TEST(OutlierLoops, a_path_is_bent_only_if_nearly_all_loops_agree) {
  const BentRounds mixed(70, 20, true);
  EXPECT_EQ(mixed.false_on, 0U);
  EXPECT_LT(mixed.true_on, 60U);
}

TEST(OutlierLoops, does_not_bend_a_path_for_false_loops) {
  for (const std::size_t false_loops : {30U, 70U, 300U}) {
    const BentRounds straight(70, false_loops, false);
    EXPECT_EQ(straight.true_on, 70U) << false_loops;
    EXPECT_EQ(straight.false_on, 0U) << false_loops;
    EXPECT_LT(straight.worst_m, 0.02) << false_loops;
  }
}

TEST(OutlierLoops, keeps_a_loop_at_the_limit) {
  PoseGraph graph = odometry_chain();
  const std::vector<std::size_t> loops = {add_bent_loop(graph, 19, 3)};
  SparsePoseAdjustment solver = plain_solver();
  PoseGraph copy = graph;
  const double chi = std::sqrt(solver.optimize(copy).fits[loops[0]].chi2);
  ASSERT_GT(chi, 0.01);
  copy = graph;
  switch_off_outlier_loops(copy, solver, loops, chi * 1.001);
  EXPECT_TRUE(copy.enabled(loops[0]));
  copy = graph;
  switch_off_outlier_loops(copy, solver, loops, chi * 0.999);
  EXPECT_FALSE(copy.enabled(loops[0]));
}

// As odometry_chain(), but with fifty copies of each constraint. A solver that takes the errors of copies for
// independent makes the chain much stiffer than its best path.
PoseGraph stiff_chain() {
  PoseGraph graph = odometry_chain();
  const std::vector<Constraint> path = graph.constraints();
  for (int copy = 1; copy < 50; ++copy)
    for (const Constraint& step : path) graph.add_constraint(step);
  return graph;
}

TEST(OutlierLoops, keeps_the_only_loop_of_a_ring_if_the_best_path_does_not_contradict_it) {
  for (const double path_chi_of_loop : {3.6, 3.9}) {
    PoseGraph graph = stiff_chain();
    const std::size_t probe = add_bent_loop(graph, 19, 1);
    graph.set_enabled(probe, false);
    const double off_m = path_chi_of_loop / path_chi(graph, {probe}).front();
    const std::vector<std::size_t> loops = {add_bent_loop(graph, 19, off_m)};
    SparsePoseAdjustment solver = plain_solver();
    const std::vector<double> chi = switch_off_outlier_loops(graph, solver, loops, kOutlierChi);
    EXPECT_GT(chi[0], kOutlierChi) << "the stiff chain leaves most of the error to the loop";
    EXPECT_EQ(graph.enabled(loops[0]), path_chi_of_loop < kPlausibleShare * kOutlierChi);
  }
}

TEST(OutlierLoops, disables_a_loop_that_the_path_through_other_loops_contradicts) {
  PoseGraph graph = stiff_chain();
  std::vector<std::size_t> loops;
  for (const std::size_t to : {17U, 18U, 18U, 19U}) loops.push_back(add_bent_loop(graph, to, 0));
  loops.push_back(add_bent_loop(graph, 19, 0.5));
  for (const std::size_t loop : loops) graph.set_enabled(loop, false);
  ASSERT_LT(path_chi(graph, {loops.back()}).front(), kPlausibleShare * kOutlierChi)
      << "the path without loops does not tell";
  for (const std::size_t loop : loops) graph.set_enabled(loop, true);
  SparsePoseAdjustment solver = plain_solver();
  switch_off_outlier_loops(graph, solver, loops, kOutlierChi);
  for (std::size_t i = 0; i < loops.size(); ++i) EXPECT_EQ(graph.enabled(loops[i]), i < 4) << i;
}

TEST(OutlierLoops, a_graph_without_loops_is_optimised) {
  PoseGraph graph = odometry_chain();
  graph.set_pose(19, {25, 3, 1});
  SparsePoseAdjustment solver = plain_solver();
  EXPECT_TRUE(switch_off_outlier_loops(graph, solver, {}, kOutlierChi).empty());
  EXPECT_NEAR(graph.pose(19).x, 19, 1e-6);
}

}  // namespace
}  // namespace psi_slam
