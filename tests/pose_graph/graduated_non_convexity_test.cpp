// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/graduated_non_convexity.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pose_graph/g2o_file.h"
#include "shared_logs.h"
#include "test_graphs.h"

namespace psi_slam {
namespace {

enum class Falsehood { kAnywhere, kNearby };

// Adds false loops until the fraction `share` of all loops is false. kAnywhere joins arbitrary nodes. kNearby
// joins nodes of a true loop with an error of metres, as a match in a corridor can have.
PoseGraph with_false_loops(const PoseGraph& graph, double share, Falsehood falsehood) {
  PoseGraph result = graph;
  Measurer measurer(7);
  std::vector<std::size_t> loops;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i)
    if (graph.constraint(i).kind == Constraint::Kind::kLoop) loops.push_back(i);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(loops.size()) / (1 - share));
  for (std::size_t k = 0; k < count; ++k) {
    Constraint wrong = graph.constraint(loops[measurer.index(loops.size())]);
    if (falsehood == Falsehood::kAnywhere) {
      wrong.from = measurer.index(graph.num_nodes());
      wrong.to = (wrong.from + 1 + measurer.index(graph.num_nodes() - 1)) % graph.num_nodes();
    } else {
      wrong.from_T_to =
          compose(wrong.from_T_to, {2 * measurer.normal(), 2 * measurer.normal(), 0.3 * measurer.normal()});
    }
    result.add_constraint(wrong);
  }
  return result;
}

double rms_distance(const PoseGraph& a, const PoseGraph& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.num_nodes(); ++i)
    sum += std::pow(a.pose(i).x - b.pose(i).x, 2) + std::pow(a.pose(i).y - b.pose(i).y, 2);
  return std::sqrt(sum / static_cast<double>(a.num_nodes()));
}

PoseGraph solved(PoseGraph graph) {
  SparsePoseAdjustment solver;
  solver.optimize(graph);
  return graph;
}

std::size_t count_from(const std::vector<std::size_t>& sorted, std::size_t first) {
  return static_cast<std::size_t>(sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), first));
}

void expect_to_survive(const PoseGraph& graph, double share, Falsehood falsehood, double tolerance_m) {
  const PoseGraph clean = solved(graph);
  PoseGraph spoilt = with_false_loops(graph, share, falsehood);
  const std::size_t num_false = spoilt.num_constraints() - graph.num_constraints();
  ASSERT_GT(num_false, 0U);
  SparsePoseAdjustment solver;
  const GraduatedReport report = optimize_graduated(spoilt, solver);
  EXPECT_LT(rms_distance(spoilt, clean), tolerance_m)
      << share << (falsehood == Falsehood::kAnywhere ? " anywhere" : " nearby") << ", nodes "
      << graph.num_nodes();
  EXPECT_GE(static_cast<double>(count_from(report.outliers, graph.num_constraints())),
            0.95 * static_cast<double>(num_false));
  for (std::size_t i = graph.num_constraints(); i < spoilt.num_constraints(); ++i)
    EXPECT_TRUE(report.solution.fits[i].chi2 < 100 || report.solution.fits[i].weight < 0.02);
}

TEST(GraduatedNonConvexity, survives_false_loops_in_a_building) {
  const KnownGraph known = building(1500, 2, 2);
  for (const double share : {0.1, 0.3})
    for (const Falsehood falsehood : {Falsehood::kAnywhere, Falsehood::kNearby})
      expect_to_survive(known.graph, share, falsehood, 0.02);
}

TEST(GraduatedNonConvexity, survives_false_loops_while_it_closes_a_drifted_ring) {
  const KnownGraph known = ring(300, 20, 1, 0.05, 0.01);
  for (const double share : {0.1, 0.3})
    for (const Falsehood falsehood : {Falsehood::kAnywhere, Falsehood::kNearby})
      expect_to_survive(known.graph, share, falsehood, 0.1);
}

TEST(GraduatedNonConvexity, survives_false_loops_in_public_graphs) {
  for (const char* name : {"input_INTEL_g2o.g2o.gz", "CSAIL.g2o.gz", "FR079_P_toro.graph.gz"}) {
    const auto path = shared_file(std::string("posegraphs/") + name);
    if (!path) GTEST_SKIP() << kNeedsData;
    const PoseGraph graph = read_pose_graph(*path).graph;
    for (const double share : {0.1, 0.3})
      for (const Falsehood falsehood : {Falsehood::kAnywhere, Falsehood::kNearby})
        expect_to_survive(graph, share, falsehood, 0.25);
  }
}

TEST(GraduatedNonConvexity, hardly_changes_a_graph_without_false_loops) {
  const KnownGraph known = building(1000, 2, 2);
  const PoseGraph clean = solved(known.graph);
  PoseGraph graph = known.graph;
  SparsePoseAdjustment solver;
  const double before = graph.chi2();
  const GraduatedReport report = optimize_graduated(graph, solver);
  EXPECT_LT(rms_distance(graph, clean), 0.02);
  EXPECT_NEAR(report.solution.initial_chi2, before, 1e-9 * before);
  std::size_t loops = 0;
  for (const Constraint& constraint : graph.constraints())
    loops += constraint.kind == Constraint::Kind::kLoop;
  EXPECT_LT(static_cast<double>(report.outliers.size()), 0.03 * static_cast<double>(loops))
      << "about 1 % of the true loops exceed the 99 % quantile";
}

TEST(GraduatedNonConvexity, restores_the_options_of_the_solver) {
  PoseAdjustmentOptions options;
  options.loop_kernel = {RobustKernel::Type::kCauchy, 2.5};
  options.max_iterations = 33;
  SparsePoseAdjustment solver(options);
  KnownGraph known = ring(30, 2, 1);
  optimize_graduated(known.graph, solver);
  EXPECT_EQ(solver.options().loop_kernel.type, RobustKernel::Type::kCauchy);
  EXPECT_EQ(solver.options().max_iterations, 33);
  PoseGraph unlinked;
  unlinked.add_node({0, 0, 0});
  unlinked.add_node({1, 0, 0});
  EXPECT_ANY_THROW(optimize_graduated(unlinked, solver));
  EXPECT_EQ(solver.options().max_iterations, 33);
}

TEST(GraduatedNonConvexity, accepts_graphs_without_loops) {
  KnownGraph known = ring(30, 0, 1);
  SparsePoseAdjustment solver;
  const GraduatedReport report = optimize_graduated(known.graph, solver);
  EXPECT_TRUE(report.solution.converged);
  EXPECT_TRUE(report.outliers.empty());
  PoseGraph empty;
  EXPECT_TRUE(optimize_graduated(empty, solver).solution.converged);
}

}  // namespace
}  // namespace psi_slam
