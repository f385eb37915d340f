// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/mapper_implementation.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "frames/discarded_ranges.h"
#include "frames/pose_operations.h"
#include "frames/sweep_motion.h"
#include "mapping/carried_frames.h"
#include "mapping/unplaced_runs.h"
#include "pose_graph/information_matrix.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Standard deviations of a later run's pose before any loop joins the run to the map, see information_of().
// They determine the windows of the first loop searches.
constexpr double kStartSigma_m = 0.3;
constexpr double kStartSigma_rad = radians_from_degrees(3.0L);

// Standard deviations of a provisional start. They only keep the graph connected.
constexpr double kUnknownSigma_m = 1e3;
constexpr double kUnknownSigma_rad = 30;

// Number of scans before the end of a standstill that keep their ranges. The robot may have begun to move in
// these scans, so that refine_poses() must align each of them.
constexpr std::size_t kKeptBeforeMotion = 40;
static_assert(kKeptBeforeMotion >= Standstill::kRecentScans);

// Distance added to the path between two runs. It exceeds every limit along the path, so no search along the
// path crosses from one run to the other.
double between_runs_m(const BackEndOptions& options) {
  return 1 + std::max({options.loop_closure.candidates.min_travel_m, options.loop_closure.context.travel_m,
                       options.loop_closure.attempt_distance_m, options.loop_consensus.memory_m,
                       options.loop_closure.verification.neighbourhood_m, options.final_search.travel_m});
}

/// Returns the information matrix of node_T_robot. The standard deviations apply to the pose at which the
/// robot was found, which is known best. An error of the start pose moves it like the end of a rigid arm.
Eigen::Matrix3d information_of(const RunStart& start) {
  const double c = std::cos(start.node_T_robot.phi);
  const double s = std::sin(start.node_T_robot.phi);
  const TPose2D& arm = start.robot_T_found;
  Eigen::Matrix3d moved = Eigen::Matrix3d::Identity();  // derivative of the found pose by the start pose
  moved(0, 2) = -(s * arm.x + c * arm.y);
  moved(1, 2) = c * arm.x - s * arm.y;
  return moved.transpose() * noisy_information(Eigen::Matrix3d::Zero(), kStartSigma_m, kStartSigma_rad) *
         moved;
}

}  // namespace

Mapper::Implementation::Implementation(const MapperOptions& options)
    : options_(options),
      front_end_(options.front_end),
      back_end_(options.back_end),
      solver_(options.pose_graph),
      keyframes_(make_keyframe_store()) {
  result_.psi = {options.back_end.psi.psi_1, options.back_end.psi.psi_2};
}

const FrameRecord& Mapper::Implementation::add(Frame frame) {
  FrameRecord record;
  record.time_us = frame.time_us;

  bool has_map = !front_end_.active().empty();
  FrontEndStep step;
  record.front_end_ms = front_end_clock_.time([&] { step = front_end_.add(frame, options_.close_loops); });
  if (step.lost) {
    begin_unplaced_run();
    has_map = false;
    record.front_end_ms += front_end_clock_.time([&] { step = front_end_.add(frame); });
  }
  record.odom_T_robot = frame.has_odometry ? frame.odom_T_robot : step.local_T_robot;
  rebase_odometry(record);
  record.front_end_T_robot = step.local_T_robot;
  if (has_map) record.match = step.matched ? ScanMatch::kMatched : ScanMatch::kUnmatched;
  record.response = step.response;
  record.window = step.window;
  record.evaluations = step.evaluations;
  record.node = step.node;
  record_factor(record, step);

  if (has_map) straighten_last_scan(frame, step);
  bent_last_.reset();
  if (step.straightened) bent_last_ = std::exchange(frame, *std::exchange(step.straightened, std::nullopt));
  result_.log.push_back(std::move(frame));
  thin_standstill(step);
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

// Removes the motion to the next scan, which is now known, from the last scan instead of the motion before
// it. Leaves the last scan unchanged if it has odometry, or if one of the two scans is unmatched.
void Mapper::Implementation::straighten_last_scan(const Frame& next, const FrontEndStep& step) {
  const FrameRecord& record = result_.frames.back();
  if (result_.log.back().has_odometry || record.match == ScanMatch::kUnmatched || !step.matched) return;
  Frame last = bent_last_.value_or(result_.log.back());
  if (straighten(last, step.local_T_robot - record.front_end_T_robot, seconds(next.time_us - last.time_us)))
    result_.log.back() = std::move(last);
}

// Discards the ranges of scans that repeat what the standing robot saw before.
void Mapper::Implementation::thin_standstill(const FrontEndStep& step) {
  if (!step.stands) repeated_.clear();
  if (step.repeats) repeated_.push_back(result_.log.size() - 1);
  for (; !repeated_.empty() && repeated_.front() + kKeptBeforeMotion < result_.log.size();
       repeated_.pop_front())
    discard_ranges(result_.log[repeated_.front()]);
}

void Mapper::Implementation::begin_run(const RunStart& start) {
  end_log();
  if (!keyframes_.unplaced.empty())
    keyframes_.unplaced.back().end = std::min(keyframes_.unplaced.back().end, graph_.num_nodes());
  front_end_.begin_run();
  run_start_ = start;
  follow_graph();
  result_.later_run_frames.push_back(result_.frames.size());
}

// Begins a run after an interruption that moved the robot to an unknown place. Whole-map searches look for
// this place.
void Mapper::Implementation::begin_unplaced_run() {
  const std::size_t node = graph_.num_nodes() - 1;
  const std::size_t interruption = result_.interruptions.size();
  result_.interruptions.push_back({result_.frames.size(), std::nullopt});
  is_start_provisional_ = true;
  begin_run({node, provisional_start(graph_) - graph_.pose(node), {0, 0, 0}});
  UnplacedRun run;
  run.begin = graph_.num_nodes();
  run.interruption = interruption;
  keyframes_.unplaced.push_back(run);
}

// Places the unplaced runs that new loops join to the map. The scan `frame` has found their places.
void Mapper::Implementation::place_joined_runs(std::size_t first_constraint, std::size_t frame) {
  while (const auto run = place_joined_run(first_constraint, keyframes_, graph_))
    result_.interruptions[run->interruption].found_frame = frame;
}

// Decides after all loops are settled which runs after an interruption are part of the map.
void Mapper::Implementation::lay_unjoined_runs_aside() {
  if (result_.interruptions.empty()) return;
  std::vector<UnplacedRun> runs;
  const auto node_at = [&](std::size_t frame) {
    const auto& frames = result_.node_frames;
    return static_cast<std::size_t>(std::lower_bound(frames.begin(), frames.end(), frame) - frames.begin());
  };
  for (std::size_t i = 0; i < result_.interruptions.size(); ++i) {
    const std::size_t frame = result_.interruptions[i].frame;
    const auto& begins = result_.later_run_frames;
    const auto next = std::upper_bound(begins.begin(), begins.end(), frame);
    runs.push_back({node_at(frame), next == begins.end() ? graph_.num_nodes() : node_at(*next), i});
  }
  const std::vector<UnplacedRun> aside = unjoined_runs(runs, graph_);
  for (Interruption& interruption : result_.interruptions)
    interruption.found_frame = interruption.found_frame.value_or(interruption.frame);
  for (const UnplacedRun& run : aside) result_.interruptions[run.interruption].found_frame.reset();
  lay_aside(aside, keyframes_, graph_);
}

// Transforms odometry of a later run into the odometry frame of the first run. Relative to node 0, the first
// odometry pose of the run then equals the pose in the map where the run begins. If that place is unknown,
// the odometry continues from its last pose.
void Mapper::Implementation::rebase_odometry(FrameRecord& record) {
  if (run_start_ && is_start_provisional_) {
    odom_T_run_ = result_.frames.back().odom_T_robot + inverse(record.odom_T_robot);
  } else if (run_start_) {
    const TPose2D odom_T_start = result_.frames.front().odom_T_robot + (map_T_local_ - graph_.pose(0));
    odom_T_run_ = odom_T_start + inverse(record.odom_T_robot);
  }
  if (odom_T_run_) record.odom_T_robot = *odom_T_run_ + record.odom_T_robot;
}

// Sets the pose of the front end's frame in the map from the newest node. Before the first scan of a later
// run, uses the start of that run.
void Mapper::Implementation::follow_graph() {
  if (run_start_) {
    map_T_local_ = graph_.pose(run_start_->node) + run_start_->node_T_robot;
    return;
  }
  const std::size_t newest = graph_.num_nodes() - 1;
  map_T_local_ = graph_.pose(newest) + inverse(keyframes_.nodes[newest].local_T_robot);
}

// Computes Psi for this frame. The distance from the start uses the robot's pose in the map, as corrected by
// the loops of earlier frames.
void Mapper::Implementation::record_factor(FrameRecord& record, const FrontEndStep& step) {
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

void Mapper::Implementation::add_node(const FrontEndStep& step, std::size_t frame) {
  remember_node(step, frame, keyframes_);
  result_.node_frames.push_back(frame);

  graph_.add_node(map_T_local_ + step.local_T_robot);
  constrain_to_local_maps(step, {options_.local_map_sigma_m, options_.local_map_sigma_rad}, graph_);
  if (run_start_) join_run();
}

// Joins the first node of a later run to the map by a weak constraint. The constraint keeps the graph
// connected and determines where loops are searched.
void Mapper::Implementation::join_run() {
  const std::size_t first = keyframes_.nodes.size() - 1;
  keyframes_.nodes[first].travelled_m =
      keyframes_.nodes[first - 1].travelled_m + between_runs_m(options_.back_end);
  Constraint constraint;
  constraint.from = run_start_->node;
  constraint.to = first;
  constraint.from_T_to = run_start_->node_T_robot;
  constraint.information =
      std::exchange(is_start_provisional_, false)
          ? noisy_information(Eigen::Matrix3d::Zero(), kUnknownSigma_m, kUnknownSigma_rad)
          : information_of(*run_start_);
  constraint.kind = Constraint::Kind::kRunStart;
  graph_.add_constraint(constraint);
  run_start_.reset();
}

void Mapper::Implementation::remember(const PlacedLocalMap& finished) {
  remember_local_map(finished, keyframes_);
  result_.local_maps.push_back({finished.anchor, finished.first_node, finished.last_node});
}

void Mapper::Implementation::close_loops(std::size_t node, FrameRecord& record) {
  const std::size_t constraints_before = graph_.num_constraints();
  const NodeLoops loops = back_end_.close(node, keyframes_, graph_);
  place_joined_runs(constraints_before, keyframes_.nodes[node].frame);
  record.matcher = loops.matcher;
  record.searched_loops = loops.searched;
  for (std::size_t i = 0; i < record.searches.size(); ++i)
    record.searches[i] = static_cast<int>(loops.effort.by_search[i].attempts);
  record.loops_tried = static_cast<int>(loops.effort.attempts);
  record.loops_accepted = loops.accepted;
  record.loop_evaluations = loops.effort.evaluations;
  record.evaluations += loops.effort.evaluations;
  record.loop_matching_ms = loops.effort.milliseconds;
  record.loop_closing_ms = loops.milliseconds;
  for (const auto& [matcher, effort] : loops.effort_of) result_.loop_matchers[matcher].effort += effort;
  record.pose_graph_ms = back_end_.optimize_if_due(graph_, solver_);
}

void Mapper::Implementation::finish_loops(FinalProgress& progress) {
  const auto& [matcher, effort] = back_end_.finish_loops(keyframes_, graph_, solver_, progress);
  if (effort.attempts == 0) return;
  result_.loop_matchers[matcher].effort += effort;
  result_.loop_matchers[matcher].final_search_effort += effort;
}

void Mapper::Implementation::count_accepted_loops() {
  for (const LoopRecord& loop : back_end_.loops()) {
    if (loop.verdict != LoopVerdict::kAccepted) continue;
    LoopMatcherRecord& matcher = result_.loop_matchers[loop.matcher];
    ++matcher.accepted;
    ++matcher.accepted_by_search[static_cast<std::size_t>(loop.search)];
    if (loop.in_final_search) ++matcher.accepted_in_final_search;
  }
}

void Mapper::Implementation::refine_poses(FinalProgress& progress) {
  RefinedScans scans;
  for (const FrameRecord& frame : result_.frames) scans.map_T_frame.push_back(frame.map_T_robot);
  scans.node_frames = result_.node_frames;
  scans.points = [&](std::size_t frame) {
    const std::optional<std::size_t>& node = result_.frames[frame].node;
    // Without odometry, the log may hold scans that were straightened with the motion after them.
    return node && result_.log[frame].has_odometry
               ? *keyframes_.nodes[*node].points
               : matching_points(result_.log[frame], options_.front_end.scan);
  };
  back_end_.refine(scans, graph_, progress);
  for (std::size_t i = 0; i < result_.frames.size(); ++i) {
    FrameRecord& frame = result_.frames[i];
    frame.map_T_robot = scans.map_T_frame[i];
    // A scan whose ranges were discarded follows the scan before it, which was refined.
    if (i > 0 && frame.match == ScanMatch::kMatched && !has_ranges(result_.log[i])) {
      const FrameRecord& before = result_.frames[i - 1];
      frame.map_T_robot = before.map_T_robot + (frame.front_end_T_robot - before.front_end_T_robot);
    }
  }
}

void Mapper::Implementation::end_log() {
  for (const PlacedLocalMap& finished : front_end_.finish()) remember(finished);
  serve_waiting_edits();
}

MappingResult Mapper::Implementation::finish(const std::function<bool(double)>& progress, AfterFinish after) {
  end_log();
  if (after == AfterFinish::kReopen)
    before_finish_ = {graph_, back_end_.ledger(), solver_, result_.loop_matchers, result_.interruptions};
  FinalProgress steps(options_.back_end, progress);
  const bool closes_loops = options_.close_loops && !keyframes_.nodes.empty();
  if (closes_loops) finish_loops(steps);
  lay_unjoined_runs_aside();
  result_.unmet_edits = unmet_edits();
  count_accepted_loops();
  carry_frames_along(graph_.poses(), result_.node_frames, result_.frames, result_.later_run_frames);
  if (closes_loops) refine_poses(steps);
  result_.final_search_cut_short = result_.interrupted = steps.cut_short();
  result_.graph = graph_;
  result_.loops = after == AfterFinish::kReopen ? back_end_.loops() : back_end_.ledger().take_loops();
  result_.stages = back_end_.stages();
  result_.stages.insert(result_.stages.begin(), front_end_clock_.timing());
  return std::move(result_);
}

TPose2D Mapper::Implementation::map_T_robot() const {
  return result_.frames.empty() ? TPose2D(0, 0, 0) : map_T_local_ + result_.frames.back().front_end_T_robot;
}

Mapper::Mapper() : Mapper(MapperOptions()) {}
Mapper::Mapper(const MapperOptions& options) : implementation_(std::make_unique<Implementation>(options)) {}
Mapper::~Mapper() = default;
Mapper::Mapper(Mapper&& other) noexcept = default;
Mapper& Mapper::operator=(Mapper&& other) noexcept = default;

const FrameRecord& Mapper::add(Frame frame) {
  return implementation_->add(std::move(frame));
}
void Mapper::begin_run(const RunStart& start) {
  implementation_->begin_run(start);
}
LoopEditOutcome Mapper::edit(const LoopEdit& edit) {
  return implementation_->edit(edit);
}
LoopEditOutcome Mapper::judge(const LoopEdit& edit, const std::vector<FrameRecord>& frames) const {
  return implementation_->judge(edit, frames);
}
void Mapper::end_log() {
  implementation_->end_log();
}
MappingResult Mapper::finish(const std::function<bool(double)>& progress, AfterFinish after) {
  return implementation_->finish(progress, after);
}
void Mapper::reopen(MappingResult&& result) {
  implementation_->reopen(std::move(result));
}
TPose2D Mapper::map_T_robot() const {
  return implementation_->map_T_robot();
}
const PoseGraph& Mapper::graph() const {
  return implementation_->graph();
}
const std::vector<Frame>& Mapper::log() const {
  return implementation_->result().log;
}
const std::vector<FrameRecord>& Mapper::frames() const {
  return implementation_->result().frames;
}
const std::vector<std::size_t>& Mapper::later_run_frames() const {
  return implementation_->result().later_run_frames;
}
const std::vector<LoopRecord>& Mapper::loops() const {
  return implementation_->loops();
}
const KeyframeStore& Mapper::keyframes() const {
  return implementation_->keyframes();
}
const std::vector<PlacedLocalMap>& Mapper::active_local_maps() const {
  return implementation_->active_local_maps();
}

}  // namespace psi_slam
