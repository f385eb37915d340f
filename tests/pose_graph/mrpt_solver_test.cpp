// SPDX-License-Identifier: BSD-3-Clause
// Compares the solver with MRPT's optimize_graph_spa_levmarq where MRPT's solver converges: exact
// measurements and disturbed poses. MRPT's error is the logarithm of P1 D P2^-1 in the axes of the map, with
// the poses P1 and P2 and the measurement D. So noisy measurements move the minimum of MRPT's error.
#include <gtest/gtest.h>
#include <mrpt/graphs/CNetworkOfPoses.h>
#include <mrpt/graphslam/levmarq.h>

#include "pose_graph/sparse_pose_adjustment.h"
#include "test_graphs.h"

namespace psi_slam {
namespace {

mrpt::graphs::CNetworkOfPoses2DInf mrpt_network(const PoseGraph& graph) {
  mrpt::graphs::CNetworkOfPoses2DInf network;
  network.root = graph.root();
  for (std::size_t i = 0; i < graph.num_nodes(); ++i) network.nodes[i] = mrpt::poses::CPose2D(graph.pose(i));
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    if (!graph.enabled(i)) continue;
    const Constraint& constraint = graph.constraint(i);
    const mrpt::math::CMatrixDouble33 information(constraint.information);
    network.insertEdgeAtEnd(constraint.from, constraint.to,
                            {mrpt::poses::CPose2D(constraint.from_T_to), information});
  }
  return network;
}

PoseGraph solved_by_mrpt(const PoseGraph& graph) {
  mrpt::graphs::CNetworkOfPoses2DInf network = mrpt_network(graph);
  mrpt::graphslam::TResultInfoSpaLevMarq info;
  mrpt::containers::yaml options;
  options["max_iterations"] = 200;
  mrpt::graphslam::optimize_graph_spa_levmarq(network, info, nullptr, options);
  PoseGraph result = graph;
  for (std::size_t node = 0; node < graph.num_nodes(); ++node)
    result.set_pose(node, network.nodes.at(node).asTPose());
  return result;
}

// Returns a ring with steps of 1 m and disturbed poses. Loops have the same information as odometry.
KnownGraph disturbed_ring(double noise) {
  KnownGraph known = ring(100, 5, noise, 0.05, 0.01);
  Measurer measurer(3);
  for (std::size_t i = 1; i < 100; ++i)
    known.graph.set_pose(i, compose(known.truth[i], {0.05 * measurer.normal(), 0.05 * measurer.normal(),
                                                     0.02 * measurer.normal()}));
  return known;
}

TEST(SparsePoseAdjustment, ends_where_MRPT_does_without_noise) {
  KnownGraph known = disturbed_ring(0);
  const PoseGraph mrpt = solved_by_mrpt(known.graph);
  SparsePoseAdjustment solver;
  solver.optimize(known.graph);
  EXPECT_LT(mrpt.chi2(), 1e-3) << "MRPT's solver converges here";
  for (std::size_t node = 0; node < known.truth.size(); ++node) {
    EXPECT_NEAR(known.graph.pose(node).x, mrpt.pose(node).x, 1e-3);
    EXPECT_NEAR(known.graph.pose(node).y, mrpt.pose(node).y, 1e-3);
    EXPECT_NEAR(wrap_to_pi(known.graph.pose(node).phi - mrpt.pose(node).phi), 0, 1e-3);
  }
}

TEST(SparsePoseAdjustment, is_no_worse_than_MRPT_with_noise) {
  KnownGraph known = disturbed_ring(0.3);
  const PoseGraph mrpt = solved_by_mrpt(known.graph);
  SparsePoseAdjustment solver;
  const PoseAdjustmentReport report = solver.optimize(known.graph);
  EXPECT_LT(mrpt.chi2(), report.initial_chi2);
  EXPECT_LE(report.final_chi2, mrpt.chi2());
}

}  // namespace
}  // namespace psi_slam
