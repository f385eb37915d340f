// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping/mapper.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

Eigen::Matrix3d information_of(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m), 1 / (sigma_rad * sigma_rad))
      .asDiagonal();
}

}  // namespace

Mapper::Mapper(const MapperOptions& options)
    : options_(options),
      front_end_(options.front_end),
      loop_matcher_(options.loop_matcher),
      loop_closer_(options.loop_closure),
      solver_(options.pose_graph) {}

const FrameRecord& Mapper::add(Frame frame) {
  FrameRecord record;
  record.time_us = frame.time_us;
  record.odom_T_robot = frame.odom_T_robot;

  FrontEndStep step;
  record.front_end_ms = front_end_clock_.time([&] { step = front_end_.add(frame); });
  record.front_end_T_robot = step.local_T_robot;
  record.response = step.response;
  record.window = step.window;
  record.evaluations = step.evaluations;
  record.node = step.node;

  result_.log.push_back(std::move(frame));
  if (step.node) {
    add_node(step, result_.frames.size());
    if (step.finished) remember(*step.finished);
    if (options_.close_loops) close_loops(*step.node, record);
    map_T_local_ = graph_.pose(*step.node) + (TPose2D(0, 0, 0) - memory_.nodes[*step.node].local_T_robot);
  }
  record.map_T_robot = map_T_local_ + step.local_T_robot;
  result_.frames.push_back(record);
  return result_.frames.back();
}

void Mapper::add_node(const FrontEndStep& step, std::size_t frame) {
  NodeScan scan;
  scan.frame = frame;
  scan.local_T_robot = step.local_T_robot;
  scan.points = step.points;
  if (!memory_.nodes.empty()) {
    const TPose2D motion = step.local_T_robot - memory_.nodes.back().local_T_robot;
    scan.travelled_m = memory_.nodes.back().travelled_m + std::hypot(motion.x, motion.y);
  }
  memory_.nodes.push_back(std::move(scan));
  result_.node_frames.push_back(frame);

  graph_.add_node(map_T_local_ + step.local_T_robot);
  for (const FrontEndStep::Membership& membership : step.memberships) {
    Constraint constraint;
    constraint.from = membership.anchor;
    constraint.to = *step.node;
    constraint.from_T_to = membership.anchor_T_node;
    constraint.information = information_of(options_.local_map_sigma_m, options_.local_map_sigma_rad);
    constraint.kind = Constraint::Kind::kLocalMap;
    graph_.add_constraint(constraint);
  }
}

void Mapper::remember(const PlacedLocalMap& finished) {
  memory_.local_maps.push_back(finished);
  result_.local_maps.push_back({finished.anchor, finished.first_node, finished.last_node});
}

void Mapper::close_loops(std::size_t node, FrameRecord& record) {
  bool moved = false;
  record.loop_closing_ms = loop_clock_.time([&] {
    for (LoopRecord& loop : loop_closer_.close(node, memory_, graph_, loop_matcher_)) {
      record.evaluations += loop.evaluations;
      if (loop.verdict == LoopVerdict::kAccepted) {
        ++record.loops_accepted;
        const TPose2D off = loop.anchor_T_node - (graph_.pose(node) - graph_.pose(loop.anchor));
        moved = moved || std::hypot(off.x, off.y) > options_.loop_sigma_m ||
                std::abs(off.phi) > options_.loop_sigma_rad;
        add_loop_constraint(loop);
      }
      result_.loops.push_back(std::move(loop));
    }
  });
  record.loops_tried = loop_closer_.tried();
  if (record.loops_tried > 0) record.matcher = loop_matcher_.name();
  if (moved) optimize(&record);
}

void Mapper::add_loop_constraint(LoopRecord& loop) {
  Constraint constraint;
  constraint.from = loop.anchor;
  constraint.to = loop.node;
  constraint.from_T_to = loop.anchor_T_node;
  Eigen::Matrix3d covariance = loop.covariance;
  covariance.diagonal() += Eigen::Vector3d(options_.loop_sigma_m * options_.loop_sigma_m,
                                           options_.loop_sigma_m * options_.loop_sigma_m,
                                           options_.loop_sigma_rad * options_.loop_sigma_rad);
  const Eigen::Matrix3d information = covariance.inverse();
  constraint.information = 0.5 * (information + information.transpose());
  constraint.kind = Constraint::Kind::kLoop;
  loop_constraints_.push_back(graph_.add_constraint(constraint));
  constraint_loop_.push_back(result_.loops.size());
}

void Mapper::optimize(FrameRecord* record) {
  const double ms = graph_clock_.time([&] { solver_.optimize(graph_); });
  if (record != nullptr) record->pose_graph_ms = ms;
}

void Mapper::switch_off_contradicted_loops() {}

void Mapper::last_pass() {
  for (std::size_t m = 0; m < memory_.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = memory_.local_maps[m];
    double last_m = -1e9;
    for (std::size_t node = 0; node < memory_.nodes.size(); ++node) {
      const NodeScan& here = memory_.nodes[node];
      if (node >= local_map.first_node && node <= local_map.last_node) continue;
      if (std::abs(here.travelled_m - last_m) < options_.last_pass_travel_m) continue;
      const TPose2D predicted = graph_.pose(node) - graph_.pose(local_map.anchor);
      bool near = false;
      for (std::size_t other = local_map.first_node; other <= local_map.last_node && !near; other += 3) {
        near =
            std::hypot(graph_.pose(other).x - graph_.pose(node).x,
                       graph_.pose(other).y - graph_.pose(node).y) < options_.loop_closure.candidates.reach_m;
      }
      if (!near) continue;
      last_m = here.travelled_m;
      MatchProblem problem{
          local_map.map->scores(),
          *here.points,
          predicted,
          {options_.last_pass_window_m, options_.last_pass_window_m, options_.last_pass_window_rad}};
      problem.min_response = 0.4;
      const MatchResult match = loop_matcher_.match(problem);
      if (!match.found) continue;
      LoopRecord loop;
      loop.frame = here.frame;
      loop.node = node;
      loop.local_map = m;
      loop.anchor = local_map.anchor;
      loop.matcher = loop_matcher_.name();
      loop.in_last_pass = true;
      loop.anchor_T_node = match.map_T_robot;
      loop.covariance = match.covariance;
      loop.window = problem.extent;
      loop.response = match.response;
      verify(loop, memory_, options_.loop_closure.verification);
      if (loop.verdict == LoopVerdict::kAccepted) add_loop_constraint(loop);
      result_.loops.push_back(std::move(loop));
    }
  }
}

void Mapper::carry_frames_along() {
  std::size_t node = 0;
  for (std::size_t i = 0; i < result_.frames.size(); ++i) {
    while (node + 1 < result_.node_frames.size() && result_.node_frames[node + 1] <= i) ++node;
    FrameRecord& frame = result_.frames[i];
    const TPose2D local_T_robot = frame.front_end_T_robot;
    const auto carried = [&](std::size_t by) {
      return graph_.pose(by) + (local_T_robot - memory_.nodes[by].local_T_robot);
    };
    TPose2D pose = carried(node);
    if (node + 1 < result_.node_frames.size()) {
      const TPose2D next = carried(node + 1);
      const double u = static_cast<double>(i - result_.node_frames[node]) /
                       static_cast<double>(result_.node_frames[node + 1] - result_.node_frames[node]);
      const TPose2D off = next - pose;
      pose = pose + TPose2D(u * off.x, u * off.y, u * off.phi);
    }
    frame.map_T_robot = pose;
    frame.map_T_robot.normalizePhi();
  }
}

MappingResult Mapper::finish() {
  for (const PlacedLocalMap& finished : front_end_.finish()) remember(finished);
  if (options_.close_loops && !memory_.nodes.empty()) {
    optimize(nullptr);
    for (int pass = 0; pass < options_.last_passes; ++pass) {
      for (std::size_t i = 0; i < loop_constraints_.size(); ++i)
        graph_.set_enabled(loop_constraints_[i], false);
      loop_constraints_.clear();
      constraint_loop_.clear();
      result_.loops.clear();
      last_pass_clock_.time([&] { last_pass(); });
      optimize(nullptr);
    }
  }
  carry_frames_along();
  result_.graph = graph_.to_mrpt();
  for (const StageClock* clock : {&front_end_clock_, &loop_clock_, &graph_clock_, &last_pass_clock_})
    result_.stages.push_back(clock->timing());
  return std::move(result_);
}

TPose2D Mapper::map_T_robot() const {
  return result_.frames.empty() ? TPose2D(0, 0, 0) : result_.frames.back().map_T_robot;
}

}  // namespace psi_slam
