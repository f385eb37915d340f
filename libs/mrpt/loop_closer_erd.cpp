// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closer_erd.h"

#include <iostream>
#include <numeric>
#include <utility>

#include "mrpt/class_verbosity.h"
#include "mrpt/passed_user_error.h"
#include "mrpt/graphslam_settings.h"

namespace psi_slam {

CPsiLoopCloserERD::CPsiLoopCloserERD() {
  setClassName("CPsiLoopCloserERD");
  logging_enable_keep_record = true;
}

CPsiLoopCloserERD::~CPsiLoopCloserERD() = default;

void CPsiLoopCloserERD::loadParams(const std::string& source_fname) {
  BoundSettings bound;
  through_engine([&] { load_graphslam_settings(source_fname, bound); });
  back_end_ = std::make_unique<BackEnd>(mapper_options(bound.settings));
  passes_ = bound.settings.mapper.final_search.passes;
  refinement_ = bound.settings.mapper.joint_refinement;
  params_text_ = graphslam_options_text(bound.table, kEdgeDeciderSection);
  setMinLoggingLevel(class_verbosity(source_fname, kEdgeDeciderSection));
}

SharedMap& CPsiLoopCloserERD::map() const {
  if (!map_)
    throw UserError(
        "CPsiLoopCloserERD needs the local maps of CPsiFrontEndNRD: take that as the node decider");
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

// The first node waits for the second, as the engine wants it.
std::size_t CPsiLoopCloserERD::close_loops_of_new_nodes() {
  SharedMap& map = this->map();
  if (map.memory.nodes.size() < 2) return 0;
  std::size_t made = 0;
  for (; handled_nodes_ < map.memory.nodes.size(); ++handled_nodes_) {
    const mrpt::math::TPose2D& pose = map.mirror.graph().pose(handled_nodes_);
    back_end_->move(map.odometry_m[handled_nodes_] - odometry_m_, {pose.x, pose.y});
    odometry_m_ = map.odometry_m[handled_nodes_];
    made += static_cast<std::size_t>(back_end_->close(handled_nodes_, map.memory, map.mirror.graph()).accepted);
  }
  return made;
}

void CPsiLoopCloserERD::finish(const std::function<bool(double)>& progress) {
  SharedMap& map = this->map();
  if (map.memory.nodes.size() < 2) return;
  close_loops_of_new_nodes();
  back_end_->ledger().refuse_pending();
  if (map.solver) {
    const double steps = passes_ + 1;
    bool go_on = true;
    const auto told = [&](double done) { return go_on = go_on && (!progress || progress(done / steps)); };
    PoseGraph& graph = map.mirror.graph();
    back_end_->settle(graph, *map.solver);
    for (int pass = 0; pass < passes_ && go_on; ++pass) {
      back_end_->run_final_search(map.memory, graph, [&](double share) { return told(pass + share); });
      back_end_->settle(graph, *map.solver);
    }
    back_end_->ledger().refuse_pending();
    if (go_on) refine([&](double share) { return told(passes_ + share); });
  }
  map.mirror.publish(*m_graph);
  map.mirror.remove_disabled(*m_graph);
  if (map.solver) map.mirror.write_poses(*m_graph);
}

void CPsiLoopCloserERD::refine(const std::function<bool(double)>& progress) {
  SharedMap& map = this->map();
  PoseGraph& graph = map.mirror.graph();
  RefinedScans scans;
  scans.map_T_frame = graph.poses();
  scans.node_frames.resize(graph.num_nodes());
  std::iota(scans.node_frames.begin(), scans.node_frames.end(), std::size_t{0});
  scans.points = [&](std::size_t node) { return *map.memory.nodes[node].points; };
  refine_jointly(scans, refinement_, back_end_->pool(), progress);
  const mrpt::math::TPose2D first = scans.map_T_frame.front();  // the map's frame stays that of the root
  for (std::size_t node = 0; node < graph.num_nodes(); ++node)
    graph.set_pose(node, scans.map_T_frame[node] - first);
}

void CPsiLoopCloserERD::getEdgesStats(std::map<std::string, int>* edge_type_to_num) const {
  const int loops = static_cast<int>(back_end_->accepted());
  (*edge_type_to_num)["ICP2D"] = loops;  // the engine's name for edges of range scans
  (*edge_type_to_num)["LC"] = loops;
}

void CPsiLoopCloserERD::printParams() const {
  std::cout << params_text_;
}

void CPsiLoopCloserERD::getDescriptiveReport(std::string* report_str) const {
  CEdgeRegistrationDecider::getDescriptiveReport(report_str);
  *report_str += "CPsiLoopCloserERD: " + std::to_string(back_end_->loops().size()) + " matches found, " +
                 std::to_string(back_end_->accepted()) + " accepted\n";
}

}  // namespace psi_slam
