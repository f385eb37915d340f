// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "mapping/carried_frames.h"
#include "mapping/local_maps/front_end.h"
#include "mrpt/entry_frames.h"
#include "mrpt/graph_mirror.h"
#include "mrpt/graphslam_settings.h"
#include "psi_slam/graphslam_deciders.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr char kSpeaker[] = "rawlog";

void keep_local_maps(const std::vector<PlacedLocalMap>& finished, KeyframeStore& keyframes) {
  for (const PlacedLocalMap& local_map : finished) remember_local_map(local_map, keyframes);
}

}  // namespace

struct CPsiFrontEndNRD::State {
  bool log_options_set = false;
  std::unique_ptr<EntryFrames> entries;
  std::unique_ptr<FrontEnd> front_end;
  FrontEndStep step;  ///< result for the last scan
  std::vector<FrameRecord> frames;
  std::vector<std::size_t> node_frames;
  double odometry_m = 0;
  std::size_t unmatched = 0;
  std::string params_text;
};

CPsiFrontEndNRD::CPsiFrontEndNRD() : state_(std::make_unique<State>()), map_(std::make_shared<SharedMap>()) {
  setClassName("CPsiFrontEndNRD");
  logging_enable_keep_record = true;
  map_->keyframes = make_keyframe_store();
}

CPsiFrontEndNRD::~CPsiFrontEndNRD() = default;

void CPsiFrontEndNRD::loadParams(const std::string& source_fname) {
  const DeciderParams params = read_decider_params(source_fname, kNodeDeciderSection);
  const MapperOptions& mapper = params.settings.mapper;
  if (!state_->log_options_set)
    state_->entries = std::make_unique<EntryFrames>(log_options(params.settings), kSpeaker);
  state_->front_end = std::make_unique<FrontEnd>(mapper.front_end);
  state_->params_text = params.text;
  setMinLoggingLevel(params.verbosity);
}

void CPsiFrontEndNRD::set_log_options(const LogOptions& options) {
  state_->entries = std::make_unique<EntryFrames>(options, kSpeaker);
  state_->log_options_set = true;
}

bool CPsiFrontEndNRD::updateState(mrpt::obs::CActionCollection::Ptr action,
                                  mrpt::obs::CSensoryFrame::Ptr observations,
                                  mrpt::obs::CObservation::Ptr observation) {
  return through_engine([&] {
    // The engine resets the poses of all nodes after each new node, and other deciders may add edges.
    map_->mirror.read(*m_graph);
    if (map_->solver)
      map_->mirror.write_poses(*m_graph);
    else
      map_->mirror.read_poses(*m_graph);

    state_->entries->take(action, observations, observation);
    while (const std::optional<Frame> frame = state_->entries->next())
      if (add(*frame)) return true;
    return false;
  });
}

bool CPsiFrontEndNRD::add(const Frame& frame) {
  const bool has_map = state_->front_end->has_active();
  state_->step = state_->front_end->add(frame);
  FrameRecord record;
  record.time_us = frame.time_us;
  record.odom_T_robot = frame.odom_T_robot;
  record.front_end_T_robot = state_->step.local_T_robot;
  record.response = state_->step.response;
  record.node = state_->step.node;
  if (!state_->frames.empty()) {
    const TPose2D motion = between(state_->frames.back().odom_T_robot, record.odom_T_robot);
    state_->odometry_m += portable::hypot(motion.x, motion.y);
  }
  if (has_map && !state_->step.matched) ++state_->unmatched;
  state_->frames.push_back(record);
  return checkRegistrationCondition();
}

bool CPsiFrontEndNRD::checkRegistrationCondition() {
  const std::vector<NodeScan>& nodes = map_->keyframes.nodes;
  m_since_prev_node_PDF = {};
  if (!state_->step.node) {
    if (nodes.empty()) return false;
    m_since_prev_node_PDF.mean =
        mrpt::poses::CPose2D(between(nodes.back().local_T_robot, state_->step.local_T_robot));
    return false;
  }
  add_node();
  if (*state_->step.node == 0) return false;
  map_->mirror.publish(*m_graph);
  m_prev_registered_nodeID = *state_->step.node;
  return true;
}

void CPsiFrontEndNRD::add_node() {
  KeyframeStore& keyframes = map_->keyframes;
  PoseGraph& graph = map_->mirror.graph();
  TPose2D pose(0, 0, 0);
  if (!keyframes.nodes.empty())
    pose = compose(graph.pose(graph.num_nodes() - 1),
                   between(keyframes.nodes.back().local_T_robot, state_->step.local_T_robot));
  state_->node_frames.push_back(state_->frames.size() - 1);
  remember_node(state_->step, state_->node_frames.back(), keyframes);
  map_->odometry_m.push_back(state_->odometry_m);

  graph.add_node(pose);
  constrain_to_path(state_->step, PathNoise(), keyframes, graph);
  keep_local_maps(state_->step.finished, keyframes);
}

void CPsiFrontEndNRD::finish() {
  state_->entries->end_of_log();
  while (const std::optional<Frame> frame = state_->entries->next()) add(*frame);
  keep_local_maps(state_->front_end->finish(), map_->keyframes);
}

std::vector<FrameRecord> CPsiFrontEndNRD::frames() const {
  if (state_->node_frames.empty()) return {};
  std::vector<TPose2D> map_T_node;
  for (std::size_t node = 0; node < state_->node_frames.size(); ++node) {
    const auto in_graph = m_graph->nodes.find(node);  // MRPT's graph lacks node 0 if the robot never moved
    map_T_node.push_back(in_graph == m_graph->nodes.end() ? map_->mirror.graph().pose(node)
                                                          : in_graph->second.asTPose());
  }
  std::vector<FrameRecord> frames = state_->frames;
  carry_frames_along(map_T_node, state_->node_frames, frames);
  return frames;
}

std::size_t CPsiFrontEndNRD::unmatched() const {
  return state_->unmatched;
}

void CPsiFrontEndNRD::printParams() const {
  std::cout << state_->params_text;
}

void CPsiFrontEndNRD::getDescriptiveReport(std::string* report_str) const {
  CNodeRegistrationDecider::getDescriptiveReport(report_str);
  *report_str += "CPsiFrontEndNRD: " + std::to_string(state_->frames.size()) + " scans, " +
                 std::to_string(state_->node_frames.size()) + " nodes, " +
                 std::to_string(map_->keyframes.local_maps.size()) + " finished local maps, " +
                 std::to_string(state_->unmatched) + " scans that could not be matched\n";
}

}  // namespace psi_slam
