// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/sparse_pose_gso.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "mrpt/class_verbosity.h"
#include "mrpt/passed_user_error.h"
#include "mrpt/graphslam_settings.h"
#include "pose_graph/constraint_error.h"

namespace psi_slam {
namespace {

constexpr double kUrgentResidual = 5;
constexpr double kGrowthForSmallResidual = 1e-3;

}  // namespace

CPsiSpaGSO::CPsiSpaGSO() : map_(std::make_shared<SharedMap>()) {
  setClassName("CPsiSpaGSO");
  logging_enable_keep_record = true;
  map_->solver.emplace();
}

CPsiSpaGSO::~CPsiSpaGSO() = default;

void CPsiSpaGSO::share(std::shared_ptr<SharedMap> map) {
  map_ = std::move(map);
  map_->solver.emplace();
}

void CPsiSpaGSO::loadParams(const std::string& source_fname) {
  BoundSettings bound;
  through_engine([&] { load_graphslam_settings(source_fname, bound); });
  map_->solver->set_options(bound.settings.mapper.pose_graph);
  params_text_ = graphslam_options_text(bound.table, kOptimizerSection);
  setMinLoggingLevel(class_verbosity(source_fname, kOptimizerSection));
}

bool CPsiSpaGSO::updateState(mrpt::obs::CActionCollection::Ptr /*action*/,
                             mrpt::obs::CSensoryFrame::Ptr /*observations*/,
                             mrpt::obs::CObservation::Ptr /*observation*/) {
  just_optimized_ = false;
  through_engine([&] {
    map_->mirror.read(*m_graph);
    worst_residual_ = std::max(worst_residual_, contradiction_of_new_edges());
    if (is_time_to_optimize()) optimizeGraph();
  });
  if (just_optimized_ || stale_) map_->mirror.write_poses(*m_graph);
  stale_ = m_graph->nodes.size() != nodes_in_graph_;
  nodes_in_graph_ = m_graph->nodes.size();
  return true;
}

double CPsiSpaGSO::contradiction_of_new_edges() {
  const PoseGraph& graph = map_->mirror.graph();
  double most = 0;
  for (; seen_edges_ < graph.num_constraints(); ++seen_edges_) {
    const Constraint& edge = graph.constraint(seen_edges_);
    const Eigen::Vector3d error = constraint_error(edge.from_T_to, RotatedPose(graph.pose(edge.from)),
                                                   RotatedPose(graph.pose(edge.to)));
    most = std::max(most, std::sqrt(error.dot(edge.information * error)));
  }
  return most;
}

bool CPsiSpaGSO::is_time_to_optimize() const {
  if (worst_residual_ >= kUrgentResidual) return true;
  const auto nodes = static_cast<double>(map_->mirror.graph().num_nodes());
  return worst_residual_ > 1 && nodes - static_cast<double>(optimized_nodes_) >= kGrowthForSmallResidual * nodes;
}

void CPsiSpaGSO::optimizeGraph() {
  PoseGraph& graph = map_->mirror.graph();
  map_->solver->optimize(graph);
  optimized_edges_ = graph.num_constraints();
  optimized_nodes_ = graph.num_nodes();
  worst_residual_ = 0;
  just_optimized_ = true;
  ++optimizations_;
}

void CPsiSpaGSO::finish() {
  map_->mirror.read(*m_graph);
  if (m_graph->nodes.size() < 2) return;
  if (map_->mirror.graph().num_constraints() != optimized_edges_) optimizeGraph();
  map_->mirror.write_poses(*m_graph);
}

void CPsiSpaGSO::printParams() const {
  std::cout << params_text_;
}

void CPsiSpaGSO::getDescriptiveReport(std::string* report_str) const {
  CGraphSlamOptimizer::getDescriptiveReport(report_str);
  *report_str += "CPsiSpaGSO: optimised " + std::to_string(optimizations_) + " times, chi^2 " +
                 std::to_string(map_->mirror.graph().chi2()) + " over " +
                 std::to_string(map_->mirror.graph().num_constraints()) + " edges\n";
}

}  // namespace psi_slam
