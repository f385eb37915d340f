// SPDX-License-Identifier: BSD-3-Clause
// Solves public benchmark pose graphs and compares the errors with those of undamped Gauss-Newton.
#include <gtest/gtest.h>

#include <ostream>

#include "dense_reference.h"
#include "pose_graph/g2o_file.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

struct PublicGraph {
  const char* name;
  const char* file;
};
void PrintTo(const PublicGraph& graph, std::ostream* out) {
  *out << graph.file;
}

class PublicGraphs : public testing::TestWithParam<PublicGraph> {
 protected:
  void SetUp() override {
    const auto path = shared_file(std::string("posegraphs/") + GetParam().file);
    if (!path) GTEST_SKIP() << kNeedsData;
    graph_ = read_pose_graph(*path).graph;
  }

  PoseGraph graph_;
};

INSTANTIATE_TEST_SUITE_P(
    Files, PublicGraphs,
    testing::Values(PublicGraph{"Intel", "input_INTEL_g2o.g2o.gz"},
                    PublicGraph{"M3500", "input_M3500_g2o.g2o.gz"},
                    PublicGraph{"MITb", "input_MITb_g2o.g2o.gz"}, PublicGraph{"CSAIL", "CSAIL.g2o.gz"},
                    PublicGraph{"FR079", "FR079_P_toro.graph.gz"}, PublicGraph{"FRH", "FRH_P_toro.graph.gz"},
                    PublicGraph{"Killian", "killian-small.toro.gz"},
                    PublicGraph{"Manhattan", "manhattanOlson3500.g2o.gz"},
                    PublicGraph{"City10000", "city10000.g2o.gz"}),
    [](const testing::TestParamInfo<PublicGraph>& graph) { return std::string(graph.param.name); });

TEST_P(PublicGraphs, are_solved_to_the_minimum_that_a_second_solver_finds) {
  PoseAdjustmentOptions options;
  options.loop_kernel = {};
  options.relative_tolerance = 1e-10;
  SparsePoseAdjustment solver(options);
  PoseGraph solved = graph_;
  const PoseAdjustmentReport report = solver.optimize(solved);
  EXPECT_TRUE(report.converged);
  RecordProperty("iterations", report.iterations);
  RecordProperty("chi2", std::to_string(report.final_chi2));

  // The second solver starts from the same poses. It has no damping, so MITb needs the most steps.
  PoseGraph second = graph_;
  sparse_gauss_newton(second, std::string(GetParam().name) == "MITb" ? 30 : 12);
  EXPECT_LE(report.final_chi2, second.chi2() * (1 + 1e-6));

  PoseGraph beyond = solved;
  const double decrement = sparse_gauss_newton(beyond, 1);
  EXPECT_LT(decrement, 1e-6 * report.final_chi2) << "no further decrease is possible";
}

TEST_P(PublicGraphs, are_solved_in_few_iterations_as_a_map_would_be) {
  PoseAdjustmentOptions options;
  options.loop_kernel = {};
  SparsePoseAdjustment solver(options);
  const PoseAdjustmentReport report = solver.optimize(graph_);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, std::string(GetParam().name) == "MITb" ? 20 : 8);
}

}  // namespace
}  // namespace psi_slam
