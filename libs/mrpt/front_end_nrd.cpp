// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/front_end_nrd.h"

#include <cmath>
#include <iostream>

#include "mrpt/class_verbosity.h"
#include "mrpt/passed_user_error.h"
#include "mrpt/graphslam_settings.h"
#include "mapping/carried_frames.h"
#include "exports/mapped_trajectory.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr char kSpeaker[] = "rawlog: ";

double length_m(const TPose2D& motion) {
  return std::hypot(motion.x, motion.y);
}

void keep_local_maps(const std::vector<PlacedLocalMap>& finished, KeyframeStore& memory) {
  for (const PlacedLocalMap& local_map : finished) remember_local_map(local_map, memory);
}

}  // namespace

CPsiFrontEndNRD::CPsiFrontEndNRD() : map_(std::make_shared<SharedMap>()) {
  setClassName("CPsiFrontEndNRD");
  logging_enable_keep_record = true;
  map_->memory = make_keyframe_store();
}

CPsiFrontEndNRD::~CPsiFrontEndNRD() = default;

void CPsiFrontEndNRD::loadParams(const std::string& source_fname) {
  BoundSettings bound;
  through_engine([&] { load_graphslam_settings(source_fname, bound); });
  const Settings& settings = bound.settings;
  options_ = {settings.mapper.front_end,
              {settings.mapper.local_map_sigma_m, settings.mapper.local_map_sigma_rad}};
  if (!log_options_set_) entries_ = std::make_unique<EntryFrames>(log_options(settings), kSpeaker);
  front_end_ = std::make_unique<FrontEnd>(options_.front_end);
  params_text_ = graphslam_options_text(bound.table, kNodeDeciderSection);
  setMinLoggingLevel(class_verbosity(source_fname, kNodeDeciderSection));
}

void CPsiFrontEndNRD::set_log_options(const LogOptions& options) {
  entries_ = std::make_unique<EntryFrames>(options, kSpeaker);
  log_options_set_ = true;
}

bool CPsiFrontEndNRD::updateState(mrpt::obs::CActionCollection::Ptr action,
                                  mrpt::obs::CSensoryFrame::Ptr observations,
                                  mrpt::obs::CObservation::Ptr observation) {
  return through_engine([&] { return update(action, observations, observation); });
}

bool CPsiFrontEndNRD::update(const mrpt::obs::CActionCollection::Ptr& action,
                             const mrpt::obs::CSensoryFrame::Ptr& observations,
                             const mrpt::obs::CObservation::Ptr& observation) {
  // The engine has moved all nodes since its last new one; others may have added edges.
  map_->mirror.read(*m_graph);
  if (map_->solver)
    map_->mirror.write_poses(*m_graph);
  else
    map_->mirror.read_poses(*m_graph);

  entries_->take(action, observations, observation);
  bool registered = false;
  while (!registered) {
    const std::optional<Frame> frame = entries_->next();
    if (!frame) break;
    registered = add(*frame);
  }
  return registered;
}

bool CPsiFrontEndNRD::add(const Frame& frame) {
  step_ = front_end_->add(frame);
  FrameRecord record;
  record.time_us = frame.time_us;
  record.odom_T_robot = frame.odom_T_robot;
  record.front_end_T_robot = step_.local_T_robot;
  record.response = step_.response;
  record.node = step_.node;
  if (!frames_.empty()) odometry_m_ += length_m(record.odom_T_robot - frames_.back().odom_T_robot);
  if (!step_.matched) ++unmatched_;
  frames_.push_back(record);
  return checkRegistrationCondition();
}

bool CPsiFrontEndNRD::checkRegistrationCondition() {
  const std::vector<NodeScan>& nodes = map_->memory.nodes;
  m_since_prev_node_PDF = {};
  if (!step_.node) {
    if (nodes.empty()) return false;
    m_since_prev_node_PDF.mean = mrpt::poses::CPose2D(step_.local_T_robot - nodes.back().local_T_robot);
    return false;
  }
  add_node();
  if (*step_.node == 0) return false;
  map_->mirror.publish(*m_graph);
  m_prev_registered_nodeID = *step_.node;
  return true;
}

void CPsiFrontEndNRD::add_node() {
  KeyframeStore& memory = map_->memory;
  PoseGraph& graph = map_->mirror.graph();
  TPose2D pose(0, 0, 0);
  if (!memory.nodes.empty())
    pose = graph.pose(graph.num_nodes() - 1) + (step_.local_T_robot - memory.nodes.back().local_T_robot);
  node_frames_.push_back(frames_.size() - 1);
  remember_node(step_, node_frames_.back(), memory);
  map_->odometry_m.push_back(odometry_m_);

  graph.add_node(pose);
  constrain_to_local_maps(step_, options_.local_map_noise, graph);
  keep_local_maps(step_.finished, memory);
}

void CPsiFrontEndNRD::finish() {
  entries_->end_of_log();
  while (const std::optional<Frame> frame = entries_->next()) add(*frame);
  keep_local_maps(front_end_->finish(), map_->memory);
}

Trajectory CPsiFrontEndNRD::trajectory() const {
  if (node_frames_.empty()) return {};
  std::vector<TPose2D> map_T_node;
  for (std::size_t node = 0; node < node_frames_.size(); ++node) {
    const auto in_graph = m_graph->nodes.find(node);  // not there: the only node of a robot that never moved
    map_T_node.push_back(in_graph == m_graph->nodes.end() ? map_->mirror.graph().pose(node)
                                                          : in_graph->second.asTPose());
  }
  std::vector<FrameRecord> frames = frames_;
  carry_frames_along(map_T_node, node_frames_, frames);
  return trajectory_of(frames);
}

void CPsiFrontEndNRD::printParams() const {
  std::cout << params_text_;
}

void CPsiFrontEndNRD::getDescriptiveReport(std::string* report_str) const {
  CNodeRegistrationDecider::getDescriptiveReport(report_str);
  *report_str += "CPsiFrontEndNRD: " + std::to_string(frames_.size()) + " scans, " +
                 std::to_string(node_frames_.size()) + " nodes, " +
                 std::to_string(map_->memory.local_maps.size()) + " finished local maps, " +
                 std::to_string(unmatched_) + " scans that could not be matched\n";
}

}  // namespace psi_slam
