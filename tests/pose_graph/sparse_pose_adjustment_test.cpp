// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/sparse_pose_adjustment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "dense_reference.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Type = RobustKernel::Type;

// Returns options for full convergence without robust kernels.
PoseAdjustmentOptions thorough() {
  PoseAdjustmentOptions options;
  options.max_iterations = 200;
  options.relative_tolerance = 1e-13;
  options.loop_kernel = {};
  return options;
}

double max_difference(const PoseGraph& a, const PoseGraph& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.num_nodes(); ++i) {
    const TPose2D& p = a.pose(i);
    const TPose2D& q = b.pose(i);
    largest =
        std::max({largest, std::abs(p.x - q.x), std::abs(p.y - q.y), std::abs(wrap_to_pi(p.phi - q.phi))});
  }
  return largest;
}

bool same_bytes(const PoseGraph& a, const PoseGraph& b) {
  return a.num_nodes() == b.num_nodes() &&
         std::memcmp(a.poses().data(), b.poses().data(), a.num_nodes() * sizeof(TPose2D)) == 0;
}

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

TEST(SparsePoseAdjustment, agrees_with_a_dense_Gauss_Newton) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    KnownGraph known = building(150, 2, 2, seed);
    PoseGraph reference = known.graph;
    dense_gauss_newton(reference, 12);
    SparsePoseAdjustment solver(thorough());
    const PoseAdjustmentReport report = solver.optimize(known.graph);
    EXPECT_TRUE(report.converged);
    EXPECT_LT(max_difference(known.graph, reference), 1e-6);
    EXPECT_LE(report.final_chi2, reference.chi2() * (1 + 1e-9));
    EXPECT_NEAR(report.final_chi2, known.graph.chi2(), 1e-9 * report.final_chi2);
  }
}

TEST(SparsePoseAdjustment, ends_at_a_minimum_of_the_robust_error) {
  for (const Type type : {Type::kHuber, Type::kCauchy, Type::kDynamicScaling, Type::kGemanMcClure}) {
    KnownGraph known = building(400, 1, 3, 1);
    const std::vector<Constraint>& all = known.graph.constraints();
    const auto loop = std::find_if(all.rbegin(), all.rend(),
                                   [](const Constraint& c) { return c.kind == Constraint::Kind::kLoop; });
    ASSERT_NE(loop, all.rend());
    Constraint wrong = *loop;
    wrong.from_T_to.x += 1;
    known.graph.add_constraint(wrong);
    PoseAdjustmentOptions options = thorough();
    options.loop_kernel = {type, 2};
    SparsePoseAdjustment solver(options);
    const PoseAdjustmentReport report = solver.optimize(known.graph);
    ASSERT_TRUE(report.converged);
    const auto robust_error = [&](const PoseGraph& graph) {
      double sum = 0;
      for (const Constraint& constraint : graph.constraints()) {
        const Eigen::Vector3d e =
            reference_error(constraint, graph.pose(constraint.from), graph.pose(constraint.to));
        const double chi2 = e.dot(constraint.information * e);
        sum += constraint.kind == Constraint::Kind::kLoop ? options.loop_kernel.cost(chi2) : chi2;
      }
      return sum;
    };
    EXPECT_NEAR(robust_error(known.graph), report.final_robust_chi2, 1e-9 * report.final_robust_chi2);
    for (std::size_t node = 1; node < known.graph.num_nodes(); node += 13) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (const double by : {-1e-3, 1e-3}) {
          PoseGraph moved = known.graph;
          TPose2D pose = moved.pose(node);
          pose[k] += by;
          moved.set_pose(node, pose);
          EXPECT_GT(robust_error(moved), report.final_robust_chi2);
        }
      }
    }
  }
}

TEST(SparsePoseAdjustment, reports_each_constraint_at_the_solution) {
  KnownGraph known = building(400, 1, 3, 1);
  const std::size_t off = known.graph.num_constraints() - 2;
  known.graph.set_enabled(off, false);
  PoseAdjustmentOptions options;
  options.loop_kernel = {Type::kCauchy, 1};
  SparsePoseAdjustment solver(options);
  const double before = known.graph.chi2();
  const PoseAdjustmentReport report = solver.optimize(known.graph);
  EXPECT_NEAR(report.initial_chi2, before, 1e-9 * before);
  EXPECT_LE(report.final_robust_chi2, report.initial_robust_chi2);
  ASSERT_EQ(report.fits.size(), known.graph.num_constraints());
  double sum = 0;
  double robust_sum = 0;
  for (std::size_t i = 0; i < report.fits.size(); ++i) {
    const Constraint& constraint = known.graph.constraint(i);
    const Eigen::Vector3d e =
        reference_error(constraint, known.graph.pose(constraint.from), known.graph.pose(constraint.to));
    const double chi2 = e.dot(constraint.information * e);
    EXPECT_NEAR(report.fits[i].chi2, chi2, 1e-9 + 1e-9 * chi2);
    if (i == off) {
      EXPECT_EQ(report.fits[i].weight, 0);
      continue;
    }
    const bool loop = constraint.kind == Constraint::Kind::kLoop;
    EXPECT_NEAR(report.fits[i].weight, loop ? options.loop_kernel.weight(chi2) : 1, 1e-9);
    sum += chi2;
    robust_sum += loop ? options.loop_kernel.cost(chi2) : chi2;
  }
  EXPECT_NEAR(report.final_chi2, sum, 1e-9 * sum);
  EXPECT_NEAR(report.final_robust_chi2, robust_sum, 1e-9 * robust_sum);
}

TEST(SparsePoseAdjustment, lets_a_constraint_have_its_own_kernel) {
  KnownGraph known = ring(40, 2, 0);
  Constraint wrong = known.graph.constraint(20);
  wrong.from_T_to.x += 1;
  wrong.kernel = RobustKernel{Type::kGemanMcClure, 1};
  const std::size_t index = known.graph.add_constraint(wrong);
  SparsePoseAdjustment solver;
  const PoseAdjustmentReport report = solver.optimize(known.graph);
  EXPECT_LT(report.fits[index].weight, 1e-3);
  EXPECT_LT(max_position_error(known), 0.01);
}

TEST(SparsePoseAdjustment, holds_the_root_wherever_it_is) {
  KnownGraph known = ring(60, 3, 1);
  PoseGraph elsewhere = known.graph;
  elsewhere.set_root(25);
  const TPose2D held = elsewhere.pose(25);
  SparsePoseAdjustment solver(thorough());
  const PoseAdjustmentReport first = solver.optimize(known.graph);
  const PoseAdjustmentReport second = solver.optimize(elsewhere);
  EXPECT_EQ(known.graph.pose(0), known.truth[0]);
  EXPECT_EQ(elsewhere.pose(25), held);
  EXPECT_NEAR(first.final_chi2, second.final_chi2, 1e-6 * first.final_chi2) << "the map's shape is the same";
}

TEST(SparsePoseAdjustment, closes_a_ring_whose_loops_are_much_tighter_than_its_odometry) {
  // A ring of 1000 nodes. A solver that judges steps by the unweighted error makes no progress with it.
  KnownGraph known = ring(1000, 30, 1, 0.001, 0.0002);
  PoseGraph reference = known.graph;
  sparse_gauss_newton(reference, 10);
  SparsePoseAdjustment solver(thorough());
  const PoseAdjustmentReport report = solver.optimize(known.graph);
  EXPECT_GT(report.initial_chi2, 1e7);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 10);
  EXPECT_LT(report.final_chi2, 300);
  EXPECT_LE(report.final_chi2, reference.chi2() * (1 + 1e-9));
}

TEST(SparsePoseAdjustment, closes_a_single_loop_after_more_drift_than_the_odometry_admits) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const KnownGraph known = ring(300, 1, 1, 0.05, 0.01, seed);
    PoseGraph graph;
    for (const TPose2D& pose : known.graph.poses()) graph.add_node(pose);
    for (Constraint constraint : known.graph.constraints()) {
      if (constraint.kind == Constraint::Kind::kOdometry)
        constraint.information *= 36;  // odometry claims a sixth of its true standard deviation
      graph.add_constraint(constraint);
    }
    const Constraint& loop = graph.constraints().back();
    const auto gap_m = [&] {
      return reference_error(loop, graph.pose(loop.from), graph.pose(loop.to)).head<2>().norm();
    };
    ASSERT_GT(gap_m(), 1);
    SparsePoseAdjustment solver;
    EXPECT_TRUE(solver.optimize(graph).converged);
    EXPECT_LT(gap_m(), 0.1);
  }
}

TEST(SparsePoseAdjustment, recovers_from_rejected_steps) {
  // The optimisation starts from random poses, where the first steps fail.
  int rejected = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    KnownGraph known = ring(60, 20, 0.2, 0.05, 0.01, seed);
    Measurer measurer(seed);
    for (std::size_t i = 1; i < 60; ++i)
      known.graph.set_pose(i, {30 * measurer.normal(), 30 * measurer.normal(), 3 * measurer.normal()});
    SparsePoseAdjustment solver(thorough());
    const PoseAdjustmentReport report = solver.optimize(known.graph);
    rejected += report.rejected_steps;
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.final_robust_chi2, report.initial_robust_chi2);
    const DenseSystem system = held_at_root(dense_system(known.graph));
    EXPECT_LT(system.g.dot(system.h.ldlt().solve(system.g)), 1e-4 * (1 + report.final_chi2))
        << "the solution is a stationary point";
  }
  EXPECT_GT(rejected, 0);
}

TEST(SparsePoseAdjustment, damps_undetermined_directions) {
  PoseGraph graph;
  for (int i = 0; i < 4; ++i) graph.add_node({1.2 * i, 0.1 * i, 0.1});
  for (std::size_t i = 1; i < 4; ++i) {
    Constraint constraint;
    constraint.from = i - 1;
    constraint.to = i;
    constraint.from_T_to = {1, 0, 0};
    constraint.information = Eigen::Vector3d(100, i == 2 ? 0 : 100, 100).asDiagonal();
    graph.add_constraint(constraint);
  }
  SparsePoseAdjustment solver;
  const PoseAdjustmentReport report = solver.optimize(graph);
  EXPECT_LT(report.final_chi2, 1e-3 * report.initial_chi2);
}

TEST(SparsePoseAdjustment, gives_the_same_bytes_every_time) {
  const KnownGraph known = building(800, 2, 3, 4);
  PoseGraph first = known.graph;
  PoseGraph second = known.graph;
  SparsePoseAdjustment a;
  SparsePoseAdjustment b;
  const PoseAdjustmentReport report_a = a.optimize(first);
  const PoseAdjustmentReport report_b = b.optimize(second);
  EXPECT_TRUE(same_bytes(first, second));
  EXPECT_EQ(report_a.final_robust_chi2, report_b.final_robust_chi2);
  PoseGraph third = known.graph;
  a.optimize(third);
  EXPECT_TRUE(same_bytes(first, third)) << "reusing the structure does not change the result";
}

TEST(SparsePoseAdjustment, keeps_its_structure_for_a_graph_that_did_not_grow) {
  KnownGraph known = building(300, 2, 2);
  SparsePoseAdjustment solver;
  EXPECT_FALSE(solver.optimize(known.graph).structure_reused);
  EXPECT_TRUE(solver.optimize(known.graph).structure_reused);
  known.graph.set_enabled(known.graph.num_constraints() - 1, false);
  EXPECT_TRUE(solver.optimize(known.graph).structure_reused);
}

TEST(SparsePoseAdjustment, wraps_headings_of_a_robot_that_turns_on_the_spot) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  Measurer measurer(3);
  for (std::size_t i = 1; i < 100; ++i) {
    graph.add_node({0, 0, 0.4 * static_cast<double>(i)});
    Constraint constraint;
    constraint.from = i - 1;
    constraint.to = i;
    constraint.from_T_to = {0.01 * measurer.normal(), 0.01 * measurer.normal(), 0.5};
    graph.add_constraint(constraint);
  }
  SparsePoseAdjustment solver(thorough());
  const PoseAdjustmentReport report = solver.optimize(graph);
  EXPECT_LT(report.final_chi2, 1e-12);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_GT(graph.pose(i).phi, -M_PI);
    EXPECT_LE(graph.pose(i).phi, M_PI);
    EXPECT_NEAR(wrap_to_pi(graph.pose(i).phi - 0.5 * static_cast<double>(i)), 0, 1e-9);
  }
}

TEST(SparsePoseAdjustment, stops_at_the_given_number_of_iterations_without_harm) {
  KnownGraph known = ring(200, 5, 1);
  PoseAdjustmentOptions options = thorough();
  options.max_iterations = 1;
  SparsePoseAdjustment solver(options);
  const PoseAdjustmentReport report = solver.optimize(known.graph);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_FALSE(report.converged);
  EXPECT_LE(report.final_robust_chi2, report.initial_robust_chi2);
}

TEST(SparsePoseAdjustment, names_a_node_without_a_link_to_the_root) {
  KnownGraph known = ring(10, 1, 1);
  const std::size_t lost = known.graph.add_node({1, 1, 0});
  known.graph.add_node({2, 1, 0});
  const std::vector<TPose2D> before = known.graph.poses();
  SparsePoseAdjustment solver;
  try {
    solver.optimize(known.graph);
    FAIL() << "no exception";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("node " + std::to_string(lost) + " "));
  }
  EXPECT_EQ(known.graph.poses(), before);
}

TEST(SparsePoseAdjustment, accepts_empty_and_single_node_graphs) {
  PoseGraph graph;
  SparsePoseAdjustment solver;
  EXPECT_TRUE(solver.optimize(graph).converged);
  graph.add_node({1, 2, 3});
  EXPECT_TRUE(solver.optimize(graph).converged);
  EXPECT_EQ(graph.pose(0), TPose2D(1, 2, 3));
}

}  // namespace
}  // namespace psi_slam
