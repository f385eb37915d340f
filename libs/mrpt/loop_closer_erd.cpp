// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <numeric>

#include "mapping/back_end.h"
#include "mrpt/graph_mirror.h"
#include "mrpt/graphslam_settings.h"
#include "psi_slam/graphslam_deciders.h"

namespace psi_slam {

struct CPsiLoopCloserERD::State {
  std::unique_ptr<BackEnd> back_end;
  std::size_t handled_nodes = 0;
  double odometry_m = 0;  ///< path length by odometry at the last handled node
  std::string params_text;
};

CPsiLoopCloserERD::CPsiLoopCloserERD() : state_(std::make_unique<State>()) {
  setClassName("CPsiLoopCloserERD");
  logging_enable_keep_record = true;
}

CPsiLoopCloserERD::~CPsiLoopCloserERD() = default;

void CPsiLoopCloserERD::loadParams(const std::string& source_fname) {
  const DeciderParams params = read_decider_params(source_fname, kEdgeDeciderSection);
  state_->back_end = std::make_unique<BackEnd>(mapper_options(params.settings).back_end);
  state_->params_text = params.text;
  setMinLoggingLevel(params.verbosity);
}

SharedMap& CPsiLoopCloserERD::map() const {
  if (!map_)
    throw UserError(
        "CPsiLoopCloserERD needs the local maps of CPsiFrontEndNRD. Choose it as the node decider.");
  return *map_;
}

bool CPsiLoopCloserERD::updateState(mrpt::obs::CActionCollection::Ptr /*action*/,
                                    mrpt::obs::CSensoryFrame::Ptr /*observations*/,
                                    mrpt::obs::CObservation::Ptr /*observation*/) {
  const std::size_t made = through_engine([&] { return close_loops_of_new_nodes(); });
  m_just_inserted_lc = made > 0;
  if (made > 0) map().mirror.publish(*m_graph);
  return true;
}

// Returns the number of new constraints. The engine registers the first two nodes together, so the first node
// waits for the second.
std::size_t CPsiLoopCloserERD::close_loops_of_new_nodes() {
  SharedMap& map = this->map();
  if (map.keyframes.nodes.size() < 2) return 0;
  std::size_t made = 0;
  for (; state_->handled_nodes < map.keyframes.nodes.size(); ++state_->handled_nodes) {
    const mrpt::math::TPose2D& pose = map.mirror.graph().pose(state_->handled_nodes);
    state_->back_end->move(map.odometry_m[state_->handled_nodes] - state_->odometry_m, {pose.x, pose.y});
    state_->odometry_m = map.odometry_m[state_->handled_nodes];
    made += static_cast<std::size_t>(
        state_->back_end->close(state_->handled_nodes, map.keyframes, map.mirror.graph()).accepted);
  }
  return made;
}

void CPsiLoopCloserERD::finish(const std::function<bool(double)>& progress) {
  SharedMap& map = this->map();
  if (map.keyframes.nodes.size() < 2) return;
  close_loops_of_new_nodes();
  BackEnd& back_end = *state_->back_end;
  if (map.solver) {
    PoseGraph& graph = map.mirror.graph();
    FinalProgress steps(back_end.options(), progress);
    back_end.finish_loops(map.keyframes, graph, *map.solver, steps);
    RefinedScans scans;
    scans.map_T_frame = graph.poses();
    scans.node_frames.resize(graph.num_nodes());
    std::iota(scans.node_frames.begin(), scans.node_frames.end(), std::size_t{0});
    scans.points = [&](std::size_t node) { return *map.keyframes.nodes[node].points; };
    back_end.refine(scans, graph, steps);
  } else {
    back_end.ledger().reject_candidates();
  }
  map.mirror.publish(*m_graph);
  map.mirror.remove_disabled(*m_graph);
  if (map.solver) map.mirror.write_poses(*m_graph);
}

const std::vector<LoopRecord>& CPsiLoopCloserERD::loops() const {
  return state_->back_end->loops();
}

std::size_t CPsiLoopCloserERD::accepted_loops() const {
  return state_->back_end->accepted();
}

void CPsiLoopCloserERD::getEdgesStats(std::map<std::string, int>* edge_type_to_num) const {
  const int loops = static_cast<int>(accepted_loops());
  (*edge_type_to_num)["ICP2D"] = loops;  // the engine's name for edges of range scans
  (*edge_type_to_num)["LC"] = loops;
}

void CPsiLoopCloserERD::printParams() const {
  std::cout << state_->params_text;
}

void CPsiLoopCloserERD::getDescriptiveReport(std::string* report_str) const {
  CEdgeRegistrationDecider::getDescriptiveReport(report_str);
  *report_str += "CPsiLoopCloserERD: " + std::to_string(loops().size()) + " matches found, " +
                 std::to_string(accepted_loops()) + " accepted\n";
}

}  // namespace psi_slam
