// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapper.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "frames/pose_operations.h"
#include "loop_closure/local_map_constraints.h"
#include "mapping/carried_frames.h"
#include "pose_graph/information_matrix.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// How far the place where a drive was found is trusted, until loops hold it: for the windows that they are
// looked for in.
constexpr double kStartSigma_m = 0.3;
constexpr double kStartSigma_rad = radians_from_degrees(3.0L);

// The graph is optimised at once where a loop says by this many standard deviations of loops that it is
// wrong; where less, only after it has grown by this share of itself: such news costs a node about the same
// then, however large the graph.
constexpr double kUrgentResidual = 5;
constexpr double kGrowthForSmallResidual = 1e-3;

// Drives lie so far apart along the path that nothing that looks along it reaches from one to the other.
double between_runs_m(const MapperOptions& options) {
  return 1 + std::max({options.loop_closure.candidates.min_travel_m, options.loop_closure.context.travel_m,
                       options.loop_closure.attempt_distance_m, options.loop_consensus.memory_m,
                       options.loop_closure.verification.neighbourhood_m, options.final_search.travel_m});
}

/// Of node_T_robot: the place found moves with it as a rigid arm does.
Eigen::Matrix3d information_of(const RunStart& start) {
  const double c = std::cos(start.node_T_robot.phi);
  const double s = std::sin(start.node_T_robot.phi);
  const TPose2D& arm = start.robot_T_found;
  Eigen::Matrix3d moved = Eigen::Matrix3d::Identity();  // the place found, by the start
  moved(0, 2) = -(s * arm.x + c * arm.y);
  moved(1, 2) = c * arm.x - s * arm.y;
  return moved.transpose() * noisy_information(Eigen::Matrix3d::Zero(), kStartSigma_m, kStartSigma_rad) *
         moved;
}

}  // namespace

Mapper::Mapper(const MapperOptions& options)
    : options_(options),
      front_end_(options.front_end),
      back_end_(options),
      solver_(options.pose_graph),
      memory_(make_keyframe_store()) {
  result_.psi = options.psi;
}

const FrameRecord& Mapper::add(Frame frame) {
  FrameRecord record;
  record.time_us = frame.time_us;

  FrontEndStep step;
  record.front_end_ms = front_end_clock_.time([&] { step = front_end_.add(frame); });
  record.odom_T_robot = frame.has_odometry ? frame.odom_T_robot : step.local_T_robot;
  rebase_odometry(record);
  record.front_end_T_robot = step.local_T_robot;
  record.response = step.response;
  record.window = step.window;
  record.evaluations = step.evaluations;
  record.node = step.node;
  record_factor(record, step);

  result_.log.push_back(std::move(frame));
  if (step.node) {
    add_node(step, result_.frames.size());
    for (const PlacedLocalMap& finished : step.finished) remember(finished);
    if (options_.close_loops) close_loops(*step.node, record);
    follow_graph();
  }
  record.map_T_robot = map_T_local_ + step.local_T_robot;
  result_.frames.push_back(record);
  if (step.node) serve_waiting_edits();
  return result_.frames.back();
}

void Mapper::begin_run(const RunStart& start) {
  end_log();
  front_end_.begin_run();
  run_start_ = start;
  follow_graph();
  result_.later_run_frames.push_back(result_.frames.size());
}

// Where a drive begins in the map, its odometry begins in the first drive's.
void Mapper::rebase_odometry(FrameRecord& record) {
  if (run_start_) {
    const TPose2D odom_T_start = result_.frames.front().odom_T_robot + (map_T_local_ - graph_.pose(0));
    odom_T_run_ = odom_T_start + inverse(record.odom_T_robot);
  }
  if (odom_T_run_) record.odom_T_robot = *odom_T_run_ + record.odom_T_robot;
}

// The front end's frame lies where the newest node puts it, or where the drive begins that is to come.
void Mapper::follow_graph() {
  if (run_start_) {
    map_T_local_ = graph_.pose(run_start_->node) + run_start_->node_T_robot;
    return;
  }
  const std::size_t newest = graph_.num_nodes() - 1;
  map_T_local_ = graph_.pose(newest) + inverse(memory_.nodes[newest].local_T_robot);
}

// The robot is where the front end has it, corrected by the loops of the frames before: in the map, as its
// start is.
void Mapper::record_factor(FrameRecord& record, const FrontEndStep& step) {
  double odometry_m = 0;
  if (!result_.frames.empty() && !run_start_) {
    const TPose2D motion = record.odom_T_robot - result_.frames.back().odom_T_robot;
    odometry_m = std::hypot(motion.x, motion.y);
  }
  const TPose2D map_T_robot = map_T_local_ + step.local_T_robot;
  back_end_.move(odometry_m, {map_T_robot.x, map_T_robot.y});
  const LoopClosureFactor::Value factor = back_end_.factor();
  record.psi = factor.psi;
  record.eta = factor.eta;
  record.mean_loops = factor.mean_loops;
}

void Mapper::add_node(const FrontEndStep& step, std::size_t frame) {
  remember_node(step, frame, memory_);
  result_.node_frames.push_back(frame);

  graph_.add_node(map_T_local_ + step.local_T_robot);
  constrain_to_local_maps(step, {options_.local_map_sigma_m, options_.local_map_sigma_rad}, graph_);
  if (run_start_) join_run();
}

// Loops take over: this keeps the graph in one piece until they come, and tells where to look for them.
void Mapper::join_run() {
  const std::size_t first = memory_.nodes.size() - 1;
  memory_.nodes[first].travelled_m = memory_.nodes[first - 1].travelled_m + between_runs_m(options_);
  Constraint constraint;
  constraint.from = run_start_->node;
  constraint.to = first;
  constraint.from_T_to = run_start_->node_T_robot;
  constraint.information = information_of(*run_start_);
  constraint.kind = Constraint::Kind::kRunStart;
  graph_.add_constraint(constraint);
  run_start_.reset();
}

void Mapper::remember(const PlacedLocalMap& finished) {
  remember_local_map(finished, memory_);
  result_.local_maps.push_back({finished.anchor, finished.first_node, finished.last_node});
}

void Mapper::close_loops(std::size_t node, FrameRecord& record) {
  NodeLoops loops;
  record.loop_closing_ms = loop_clock_.time([&] { loops = back_end_.close(node, memory_, graph_); });
  record.matcher = loops.matcher;
  record.loops_tried = static_cast<int>(loops.effort.attempts);
  record.loops_accepted = loops.accepted;
  record.loop_evaluations = loops.effort.evaluations;
  record.evaluations += loops.effort.evaluations;
  record.loop_matching_ms = loops.effort.milliseconds;
  result_.loop_matchers[loops.matcher].effort += loops.effort;
  worst_residual_ = std::max({worst_residual_, loops.news, loops.agreed ? kUrgentResidual : 0});
  if (!is_time_to_optimize()) return;
  record.pose_graph_ms = graph_clock_.time([&] { optimize(); });
}

void Mapper::optimize() {
  solver_.optimize(graph_);
  optimized_nodes_ = graph_.num_nodes();
  worst_residual_ = 0;
}

bool Mapper::is_time_to_optimize() const {
  if (worst_residual_ >= kUrgentResidual) return true;
  const std::size_t grown_by = graph_.num_nodes() - optimized_nodes_;
  return worst_residual_ > 1 &&
         static_cast<double>(grown_by) >= kGrowthForSmallResidual * static_cast<double>(graph_.num_nodes());
}

void Mapper::run_final_search(const std::function<bool(double)>& progress) {
  for (const auto& [matcher, effort] : back_end_.run_final_search(memory_, graph_, progress)) {
    result_.loop_matchers[matcher].effort += effort;
    result_.loop_matchers[matcher].final_search_effort += effort;
  }
}

void Mapper::settle_loops() {
  graph_clock_.time([&] { back_end_.settle(graph_, solver_); });
}

void Mapper::count_accepted_loops() {
  for (const LoopRecord& loop : back_end_.loops()) {
    if (loop.verdict != LoopVerdict::kAccepted) continue;
    ++result_.loop_matchers[loop.matcher].accepted;
    if (loop.in_final_search) ++result_.loop_matchers[loop.matcher].accepted_in_final_search;
  }
}

// Of all frames, and of the graph's nodes with them.
void Mapper::refine_poses(const std::function<bool(double)>& progress) {
  RefinedScans scans;
  for (const FrameRecord& frame : result_.frames) scans.map_T_frame.push_back(frame.map_T_robot);
  scans.node_frames = result_.node_frames;
  scans.points = [&](std::size_t frame) {
    const std::optional<std::size_t>& node = result_.frames[frame].node;
    return node ? *memory_.nodes[*node].points : matching_points(result_.log[frame], options_.front_end.scan);
  };
  refine_jointly(scans, options_.joint_refinement, back_end_.pool(), progress);
  // The map's frame stays that of the first node, as the graph has it.
  const TPose2D first = scans.map_T_frame[result_.node_frames.front()];
  for (TPose2D& pose : scans.map_T_frame) pose = graph_.pose(0) + (pose - first);
  for (std::size_t i = 0; i < result_.frames.size(); ++i)
    result_.frames[i].map_T_robot = scans.map_T_frame[i];
  for (std::size_t node = 0; node < result_.node_frames.size(); ++node)
    graph_.set_pose(node, scans.map_T_frame[result_.node_frames[node]]);
}

void Mapper::end_log() {
  for (const PlacedLocalMap& finished : front_end_.finish()) remember(finished);
  serve_waiting_edits();
}

MappingResult Mapper::finish(const std::function<bool(double)>& progress, AfterFinish after) {
  end_log();
  if (after == AfterFinish::kReopen)
    before_finish_ = {graph_, back_end_.ledger(), solver_, result_.loop_matchers};
  back_end_.ledger().refuse_pending();
  const int steps = options_.final_search.passes + (options_.joint_refinement.rounds > 0 ? 1 : 0);
  const auto go_on = [&](double done) {
    const bool wanted = !progress || progress(done / steps);
    result_.final_search_cut_short = !wanted && done < steps;
    return wanted;
  };
  if (options_.close_loops && !memory_.nodes.empty()) {
    settle_loops();
    for (int pass = 0; pass < options_.final_search.passes && !result_.final_search_cut_short; ++pass) {
      final_search_clock_.time([&] {
        run_final_search(
            [&](double share) { return final_search_clock_.leave_out([&] { return go_on(pass + share); }); });
      });
      settle_loops();
    }
    back_end_.ledger().refuse_pending();
  }
  result_.unmet_edits = unmet_edits();
  count_accepted_loops();
  carry_frames_along(graph_.poses(), result_.node_frames, result_.frames, result_.later_run_frames);
  if (options_.close_loops && !memory_.nodes.empty() && !result_.final_search_cut_short)
    refinement_clock_.time([&] {
      refine_poses([&](double share) {
        return refinement_clock_.leave_out([&] { return go_on(options_.final_search.passes + share); });
      });
    });
  result_.interrupted = result_.final_search_cut_short;
  result_.graph = graph_;
  result_.loops = after == AfterFinish::kReopen ? back_end_.loops() : back_end_.ledger().take_loops();
  for (const StageClock* clock :
       {&front_end_clock_, &loop_clock_, &graph_clock_, &final_search_clock_, &refinement_clock_})
    result_.stages.push_back(clock->timing());
  return std::move(result_);
}

TPose2D Mapper::map_T_robot() const {
  return result_.frames.empty() ? TPose2D(0, 0, 0) : map_T_local_ + result_.frames.back().front_end_T_robot;
}

}  // namespace psi_slam
