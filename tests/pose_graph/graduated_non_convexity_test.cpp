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

void expect_to_survive(const PoseGraph& graph, double share, Falsehood falsehood, double tolerance_m,
                       double inlier_width = kInlierChi) {
  const PoseGraph clean = solved(graph);
  PoseGraph spoilt = with_false_loops(graph, share, falsehood);
  const std::size_t num_false = spoilt.num_constraints() - graph.num_constraints();
  ASSERT_GT(num_false, 0U);
  SparsePoseAdjustment solver;
  GraduatedOptions options;
  options.inlier_width = inlier_width;
  const GraduatedReport report = optimize_graduated(spoilt, solver, options);
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
    // Loops of these graphs state larger deviations than they have, so a narrower width finds the false ones.
    for (const double share : {0.1, 0.3})
      for (const Falsehood falsehood : {Falsehood::kAnywhere, Falsehood::kNearby})
        expect_to_survive(graph, share, falsehood, 0.25, 3.37);
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
  EXPECT_GT(loops, 300U);
  EXPECT_LE(report.outliers.size(), 1U) << "one in 65,000 true loops exceeds the limit";
}

// A hundred loops agree exactly. One more loop is off by this many of its standard deviations.
TEST(GraduatedNonConvexity, rejects_loops_beyond_kInlierChi_by_default) {
  EXPECT_EQ(GraduatedOptions().inlier_width, kInlierChi);
  EXPECT_EQ(kInlierChi, 5);
  for (const double chi : {4.8, 5.2}) {
    PoseGraph graph = ring(60, 0, 0).graph;
    Constraint loop;
    loop.from = 10;
    loop.to = 40;
    loop.from_T_to = relative_pose(graph.pose(10), graph.pose(40));
    loop.information = Eigen::Vector3d(2500, 2500, 62500).asDiagonal();
    loop.kind = Constraint::Kind::kLoop;
    for (int i = 0; i < 100; ++i) graph.add_constraint(loop);
    loop.from_T_to.x += chi / 50;
    const std::size_t off = graph.add_constraint(loop);
    SparsePoseAdjustment solver;
    const GraduatedReport report = optimize_graduated(graph, solver);
    EXPECT_EQ(report.outliers, chi < 5 ? std::vector<std::size_t>{} : std::vector<std::size_t>{off}) << chi;
  }
}

TEST(GraduatedNonConvexity, a_loop_with_its_own_kernel_is_no_outlier) {
  PoseGraph graph = building(300, 2, 2).graph;
  Constraint wrong;
  for (const Constraint& constraint : graph.constraints())
    if (constraint.kind == Constraint::Kind::kLoop) wrong = constraint;
  wrong.from_T_to.x += 3;
  const std::size_t of_solver = graph.add_constraint(wrong);
  wrong.kernel = RobustKernel{};
  const std::size_t of_its_own = graph.add_constraint(wrong);
  const auto is_outlier = [&](const GraduatedReport& report, std::size_t loop) {
    return std::find(report.outliers.begin(), report.outliers.end(), loop) != report.outliers.end();
  };
  graph.set_enabled(of_its_own, false);
  SparsePoseAdjustment solver;
  EXPECT_TRUE(is_outlier(optimize_graduated(graph, solver), of_solver));

  graph.set_enabled(of_solver, false);
  graph.set_enabled(of_its_own, true);
  const GraduatedReport report = optimize_graduated(graph, solver);
  EXPECT_FALSE(is_outlier(report, of_its_own));
  EXPECT_EQ(report.solution.fits[of_its_own].weight, 1);
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
