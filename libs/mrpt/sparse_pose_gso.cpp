// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <utility>

#include "mapping/optimization_schedule.h"
#include "mrpt/graph_mirror.h"
#include "mrpt/graphslam_settings.h"
#include "pose_graph/constraint_error.h"
#include "psi_slam/graphslam_deciders.h"

namespace psi_slam {

struct CPsiSpaGSO::State {
  OptimizationSchedule schedule;
  std::size_t seen_edges = 0;
  std::size_t optimized_edges = 0;  ///< number of edges at the last optimisation
  std::size_t nodes_in_graph = 0;   ///< number of nodes at the last updateState()
  bool stale = false;               ///< new nodes at the last updateState(): the engine then reset the poses
  bool just_optimized = false;
  std::size_t optimizations = 0;
  std::string params_text;

  /// Reports the residuals of the new edges to the schedule, in standard deviations.
  void note_new_edges(const PoseGraph& graph) {
    for (; seen_edges < graph.num_constraints(); ++seen_edges) {
      const Constraint& edge = graph.constraint(seen_edges);
      const Eigen::Vector3d error = constraint_error(edge.from_T_to, RotatedPose(graph.pose(edge.from)),
                                                     RotatedPose(graph.pose(edge.to)));
      schedule.add_residual(std::sqrt(error.dot(edge.information * error)));
    }
  }
};

CPsiSpaGSO::CPsiSpaGSO() : state_(std::make_unique<State>()), map_(std::make_shared<SharedMap>()) {
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
  const DeciderParams params = read_decider_params(source_fname, kOptimizerSection);
  map_->solver->set_options(params.settings.mapper.pose_graph);
  state_->params_text = params.text;
  setMinLoggingLevel(params.verbosity);
}

bool CPsiSpaGSO::justFullyOptimizedGraph() const {
  return state_->just_optimized;
}

bool CPsiSpaGSO::updateState(mrpt::obs::CActionCollection::Ptr /*action*/,
                             mrpt::obs::CSensoryFrame::Ptr /*observations*/,
                             mrpt::obs::CObservation::Ptr /*observation*/) {
  state_->just_optimized = false;
  through_engine([&] {
    map_->mirror.read(*m_graph);
    state_->note_new_edges(map_->mirror.graph());
    if (state_->schedule.is_due(map_->mirror.graph())) optimizeGraph();
  });
  if (state_->just_optimized || state_->stale) map_->mirror.write_poses(*m_graph);
  state_->stale = m_graph->nodes.size() != state_->nodes_in_graph;
  state_->nodes_in_graph = m_graph->nodes.size();
  return true;
}

void CPsiSpaGSO::optimizeGraph() {
  PoseGraph& graph = map_->mirror.graph();
  map_->solver->optimize(graph);
  state_->optimized_edges = graph.num_constraints();
  state_->schedule.optimized(graph);
  state_->just_optimized = true;
  ++state_->optimizations;
}

void CPsiSpaGSO::finish() {
  map_->mirror.read(*m_graph);
  if (m_graph->nodes.size() < 2) return;
  if (map_->mirror.graph().num_constraints() != state_->optimized_edges) optimizeGraph();
  map_->mirror.write_poses(*m_graph);
}

void CPsiSpaGSO::printParams() const {
  std::cout << state_->params_text;
}

void CPsiSpaGSO::getDescriptiveReport(std::string* report_str) const {
  CGraphSlamOptimizer::getDescriptiveReport(report_str);
  *report_str += "CPsiSpaGSO: optimised " + std::to_string(state_->optimizations) + " times, chi^2 " +
                 std::to_string(map_->mirror.graph().chi2()) + " over " +
                 std::to_string(map_->mirror.graph().num_constraints()) + " edges\n";
}

}  // namespace psi_slam
