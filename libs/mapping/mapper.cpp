// SPDX-License-Identifier: BSD-3-Clause
#include "base/portable_math.h"
#include "mapping/mapper_implementation.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "logs/frames/discarded_ranges.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/sweep_motion.h"
#include "mapping/carried_frames.h"
#include "mapping/placed_knowledge.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Number of scans before the end of a standstill that keep their ranges. The robot may have begun to move in
// these scans, so that refine_poses() must align each of them.
constexpr std::size_t kKeptBeforeMotion = 40;
static_assert(kKeptBeforeMotion >= Standstill::kRecentScans);

}  // namespace

Mapper::Implementation::Implementation(const MapperOptions& options)
    : options_(options),
      front_end_(options.front_end, options.back_end_thread),
      builder_(options),
      back_end_(builder_, options.back_end_thread, options.back_end.priority) {
  result_.psi = {options.back_end.psi.psi_1, options.back_end.psi.psi_2};
}

const FrameRecord& Mapper::Implementation::add(Frame frame) {
  waited_ = false;
  FrameRecord record;
  record.time_us = frame.time_us;

  bool has_map = front_end_.has_active();
  FrontEndStep step;
  record.front_end_ms = tracking_clock_.time([&] { step = front_end_.track(frame, options_.close_loops); });
  if (step.lost) {
    begin_unplaced_run();
    has_map = false;
    record.front_end_ms += tracking_clock_.time([&] { step = front_end_.track(frame); });
  }
  record.odom_T_robot = frame.has_odometry ? frame.odom_T_robot : step.local_T_robot;
  const double odometry_m = follow_odometry(record);
  record.front_end_T_robot = step.local_T_robot;
  if (has_map) record.match = step.matched ? ScanMatch::kMatched : ScanMatch::kUnmatched;
  record.response = step.response;
  record.window = step.window;
  record.evaluations = step.evaluations;
  record.node = step.node;

  if (has_map) straighten_last_scan(frame, step);
  bent_last_.reset();
  if (step.straightened) bent_last_ = std::exchange(frame, *std::exchange(step.straightened, std::nullopt));
  frame.is_misplaced = step.misplaced;
  result_.log.push_back(std::move(frame));
  thin_standstill(step);
  result_.frames.push_back(record);
  if (step.node) add_node(step);
  // With a latency, the pose does not depend on this scan's own loops.
  const bool is_early = latency_nodes() > 0;
  std::exception_ptr failure;  // thrown after the back end has the frame, so that frames can follow
  if (is_early) failure = give_pose();
  draw(step);
  if (!step.node) step.points.reset();  // the back end needs those of nodes only
  back_end_.hand_over({result_.frames.size() - 1, odometry_m, std::move(step)});
  if (!is_early) failure = give_pose();
  if (result_.frames.back().node && can_serve_waiting_edits()) {
    wait();
    serve_waiting_edits();
  }
  if (failure) std::rethrow_exception(failure);
  return result_.frames.back();
}

// Records the node of a step.
void Mapper::Implementation::add_node(const FrontEndStep& step) {
  odom_T_start_.reset();
  result_.node_frames.push_back(result_.frames.size() - 1);
  map_T_node_.push_back(compose(map_T_local_, step.local_T_robot));
}

// Places the newest frame in the map and tells its pose. Returns what the observer or the back end threw.
std::exception_ptr Mapper::Implementation::give_pose() {
  try {
    take_due_results();
    if (waited_) ++missed_deadlines_;
    FrameRecord& added = result_.frames.back();
    added.map_T_robot = compose(map_T_local_, added.front_end_T_robot);
    if (pose_observer_) pose_observer_(added);
    return {};
  } catch (...) {
    return std::current_exception();
  }
}

// Draws the newest frame into the local maps, and records the local maps that it finished.
void Mapper::Implementation::draw(FrontEndStep& step) {
  result_.frames.back().front_end_ms +=
      drawing_clock_.time([&] { front_end_.draw(step, result_.log.back()); });
  for (const PlacedLocalMap& finished : step.finished) record_local_map(finished);
}

// Takes the results of the back end that are due: those up to the node `latency_nodes` before the newest
// node. The poses of later frames follow these results and no others, whether or not the back end is ahead.
// With run_ahead(), they follow all results that have arrived.
void Mapper::Implementation::take_due_results() {
  const std::vector<std::size_t>& nodes = result_.node_frames;
  const std::size_t latency = latency_nodes();
  // Results that came early complete the records of earlier frames at once, so that they do not pile up.
  while (latency > 0 && back_end_.in_work() > 0 && back_end_.is_ready()) complete_record(back_end_.take());
  const bool is_due = latency == 0 || (result_.frames.back().node && nodes.size() > latency);
  const std::size_t due_nodes = is_due ? nodes.size() - latency : 0;
  if (is_due) take_results(latency == 0 ? result_.frames.size() : nodes[due_nodes - 1] + 1);
  apply_corrections(runs_ahead() ? nodes.size() : due_nodes);
}

// Completes the records of the frames before `end`, and waits for their results if necessary.
void Mapper::Implementation::take_results(std::size_t end) {
  while (back_end_.taken() < end) {
    waited_ = waited_ || !back_end_.is_ready();
    complete_record(back_end_.take());
  }
}

void Mapper::Implementation::complete_record(BackEndStep&& done) {
  FrameRecord& record = result_.frames[done.frame];
  record.psi = done.factor.psi;
  record.eta = done.factor.eta;
  record.mean_loops = done.factor.mean_loops;
  for (const std::size_t interruption : done.joined)
    result_.interruptions[interruption].found_frame = done.frame;
  if (!done.node) return;
  discard_superseded(done.superseded);
  // While add() runs ahead, it applies all corrections together, so this one replaces those before.
  if (runs_ahead() && !done.map_T_node.empty()) corrections_.clear();
  corrections_.push_back({*done.node, done.map_T_local, std::move(done.map_T_node), done.covariance});
  if (!options_.close_loops) return;
  const NodeLoops& loops = done.loops;
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
  record.pose_graph_ms = done.pose_graph_ms;
}

// Discards the ranges of superseded nodes, and of the scans between each of them and the next node.
void Mapper::Implementation::discard_superseded(const std::vector<std::size_t>& nodes) {
  for (const std::size_t node : nodes)
    for (std::size_t frame = result_.node_frames[node]; frame < result_.node_frames[node + 1]; ++frame) {
      if (!has_ranges(result_.log[frame])) continue;
      if (superseded_observer_) superseded_observer_(frame, result_.log[frame]);
      discard_ranges(result_.log[frame]);
    }
}

// Applies the corrections by the nodes before `end_node`. Newer nodes follow the pose of the front end's
// frame.
void Mapper::Implementation::apply_corrections(std::size_t end_node) {
  for (; !corrections_.empty() && corrections_.front().node < end_node; corrections_.pop_front()) {
    Correction& correction = corrections_.front();
    map_T_local_ = correction.map_T_local;
    corrected_node_ = correction.node;
    covariance_ = correction.covariance;
    if (correction.map_T_node.empty()) continue;
    std::swap(map_T_node_, correction.map_T_node);
    for (std::size_t node = map_T_node_.size(); node < result_.node_frames.size(); ++node)
      map_T_node_.push_back(
          compose(map_T_local_, result_.frames[result_.node_frames[node]].front_end_T_robot));
  }
}

void Mapper::Implementation::wait() {
  take_results(back_end_.taken() + back_end_.in_work());
}

// Waits for the back end and applies all its results.
void Mapper::Implementation::catch_up() {
  wait();
  corrections_.clear();
  map_T_local_ = builder_.map_T_local();
  map_T_node_ = builder_.graph().poses();
}

// Removes the motion to the next scan, which is now known, from the last scan instead of the motion before
// it. Leaves the last scan unchanged if it has odometry, or if one of the two scans is unmatched.
void Mapper::Implementation::straighten_last_scan(const Frame& next, const FrontEndStep& step) {
  const FrameRecord& record = result_.frames.back();
  if (result_.log.back().has_odometry || record.match == ScanMatch::kUnmatched || !step.matched) return;
  Frame last = bent_last_.value_or(result_.log.back());
  if (straighten(last, between(record.front_end_T_robot, step.local_T_robot),
                 seconds(next.time_us - last.time_us)))
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
  builder_.begin_run(start);
  begin_run();
  // Relative to node 0, the first odometry pose of the run equals the pose in the map where the run begins.
  odom_T_start_ =
      compose(result_.frames.front().odom_T_robot, between(builder_.graph().pose(0), map_T_local_));
}

// Begins a run after an interruption that moved the robot to an unknown place. Its odometry continues from
// the last pose.
void Mapper::Implementation::begin_unplaced_run() {
  end_log();
  builder_.begin_unplaced_run(result_.interruptions.size());
  result_.interruptions.push_back({result_.frames.size(), std::nullopt});
  begin_run();
  odom_T_start_ = result_.frames.back().odom_T_robot;
}

void Mapper::Implementation::begin_run() {
  catch_up();
  covariance_.reset();  // the next node's covariance includes the start of the run
  front_end_.begin_run();
  result_.later_run_frames.push_back(result_.frames.size());
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
    runs.push_back({node_at(frame), next == begins.end() ? result_.node_frames.size() : node_at(*next), i});
  }
  for (Interruption& interruption : result_.interruptions)
    interruption.found_frame = interruption.found_frame.value_or(interruption.frame);
  for (const UnplacedRun& run : builder_.lay_unjoined_aside(runs))
    result_.interruptions[run.interruption].found_frame.reset();
}

// Transforms odometry of a later run into the odometry frame of the first run. Returns the path length by
// odometry since the last frame.
double Mapper::Implementation::follow_odometry(FrameRecord& record) {
  if (odom_T_start_) odom_T_run_ = compose(*odom_T_start_, inverse(record.odom_T_robot));
  if (odom_T_run_) record.odom_T_robot = compose(*odom_T_run_, record.odom_T_robot);
  if (result_.frames.empty() || odom_T_start_) return 0;
  const TPose2D motion = between(result_.frames.back().odom_T_robot, record.odom_T_robot);
  return portable::hypot(motion.x, motion.y);
}

void Mapper::Implementation::record_local_map(const PlacedLocalMap& finished) {
  result_.local_maps.push_back({finished.anchor, finished.first_node, finished.last_node});
}

void Mapper::Implementation::finish_loops(FinalProgress& progress) {
  const auto& [matcher, effort] = builder_.finish_loops(progress);
  if (effort.attempts == 0) return;
  result_.loop_matchers[matcher].effort += effort;
  result_.loop_matchers[matcher].final_search_effort += effort;
}

void Mapper::Implementation::count_accepted_loops() {
  for (const LoopRecord& loop : loops()) {
    if (loop.state != LoopState::kAccepted) continue;
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
    return node && result_.log[frame].has_odometry && !is_superseded(*node)
               ? *keyframes().nodes[*node].points
               : matching_points(result_.log[frame], options_.front_end.scan);
  };
  builder_.refine(scans, progress);
  std::size_t node = 0;
  for (std::size_t i = 0; i < result_.frames.size(); ++i) {
    FrameRecord& frame = result_.frames[i];
    node = frame.node.value_or(node);
    frame.map_T_robot = scans.map_T_frame[i];
    // A scan that repeats what the standing robot saw follows the scan before it, which was refined.
    if (i > 0 && frame.match == ScanMatch::kMatched && !has_ranges(result_.log[i]) && !is_superseded(node)) {
      const FrameRecord& before = result_.frames[i - 1];
      frame.map_T_robot =
          compose(before.map_T_robot, between(before.front_end_T_robot, frame.front_end_T_robot));
    }
  }
}

void Mapper::Implementation::end_log() {
  wait();
  if (runs_ahead()) {  // from now on, poses do not depend on the speed of the threads
    apply_corrections(result_.node_frames.size());
    catch_up();
  }
  for (const PlacedLocalMap& finished : front_end_.finish()) {
    builder_.remember(finished);
    record_local_map(finished);
  }
  serve_waiting_edits();
}

// Finds the last loops and optimises the graph, with what is known from outside.
void Mapper::Implementation::finish_graph(bool closes_loops, FinalProgress& progress) {
  result_.contradictions.clear();
  result_.knowledge = {};
  std::optional<PlacedKnowledge> known;
  if (!knowledge_.empty() && !keyframes().nodes.empty())
    known.emplace(knowledge_, result_.frames, result_.node_frames, result_.later_run_frames);
  if (known) builder_.add_landmarks(known->landmarks());
  if (closes_loops)
    finish_loops(progress);
  else
    builder_.settle_landmarks();
  lay_unjoined_runs_aside();
  if (!progress.cut_short()) result_.contradictions = contradicted_forces();
  if (!known) return;
  for (std::string& sentence : known->contradictions(*builder_.landmarks(), builder_.graph(), kInlierChi))
    result_.contradictions.push_back(std::move(sentence));
  result_.knowledge = known->counts(*builder_.landmarks(), builder_.graph());
  builder_.move_to_site();
}

MappingResult Mapper::Implementation::finish(const std::function<bool(double)>& progress, AfterFinish after) {
  end_log();
  if (after == AfterFinish::kReopen)
    before_finish_ = {builder_.checkpoint(), result_.loop_matchers, result_.interruptions};
  FinalProgress steps(options_.back_end, progress);
  const bool closes_loops = options_.close_loops && !keyframes().nodes.empty();
  finish_graph(closes_loops, steps);
  result_.unmet_edits = unmet_edits();
  count_accepted_loops();
  carry_frames_along(builder_.graph().poses(), result_.node_frames, result_.frames, result_.later_run_frames);
  if (closes_loops) refine_poses(steps);
  result_.final_search_cut_short = result_.interrupted = steps.cut_short();
  result_.graph = builder_.graph();
  result_.loops = after == AfterFinish::kReopen ? loops() : builder_.take_loops();
  result_.stages = builder_.back_end().stages();
  result_.stages.insert(result_.stages.begin(), {tracking_clock_.timing(), drawing_clock_.timing()});
  return std::move(result_);
}

// The covariance of the last node with a result of the back end is carried to the newest frame. Each node
// between the two adds the drift of that node, and the frame the noise of its match.
std::optional<Eigen::Matrix3d> Mapper::Implementation::newest_covariance() const {
  if (!covariance_ || result_.frames.empty()) return std::nullopt;
  const FrameRecord& newest = result_.frames.back();
  Eigen::Matrix3d covariance =
      carried_covariance(covariance_->covariance, covariance_->map_T_node, newest.map_T_robot);
  covariance += static_cast<double>(result_.node_frames.size() - 1 - corrected_node_) * covariance_->drift;
  const double sigma_m = options_.path_noise.scan_sigma_m;
  const double sigma_rad = options_.path_noise.scan_sigma_rad;
  covariance.diagonal() += Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  return covariance;
}

TPose2D Mapper::Implementation::map_T_robot() const {
  return result_.frames.empty() ? TPose2D(0, 0, 0)
                                : compose(map_T_local_, result_.frames.back().front_end_T_robot);
}

Mapper::Mapper() : Mapper(MapperOptions()) {}
Mapper::Mapper(const MapperOptions& options) : implementation_(std::make_unique<Implementation>(options)) {}
Mapper::~Mapper() = default;
Mapper::Mapper(Mapper&& other) noexcept = default;
Mapper& Mapper::operator=(Mapper&& other) noexcept = default;

void Mapper::set_pose_observer(PoseObserver observer) {
  implementation_->set_pose_observer(std::move(observer));
}
void Mapper::set_superseded_observer(ScanObserver observer) {
  implementation_->set_superseded_observer(std::move(observer));
}
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
  implementation_->wait();
  return implementation_->judge(edit, frames);
}
void Mapper::set_knowledge(FixedKnowledge knowledge) {
  implementation_->set_knowledge(std::move(knowledge));
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
  implementation_->wait();
  return implementation_->graph();
}
const std::vector<Frame>& Mapper::log() const {
  return implementation_->result().log;
}
const std::vector<FrameRecord>& Mapper::frames() const {
  return implementation_->result().frames;
}
const std::vector<TPose2D>& Mapper::node_poses() const {
  return implementation_->map_T_node();
}
std::optional<Eigen::Matrix3d> Mapper::newest_covariance() const {
  return implementation_->newest_covariance();
}
void Mapper::run_ahead(std::optional<std::size_t> nodes) {
  implementation_->run_ahead(nodes);
}
std::size_t Mapper::missed_deadlines() const {
  return implementation_->missed_deadlines();
}
void Mapper::wait() const {
  implementation_->wait();
}
const std::vector<std::size_t>& Mapper::later_run_frames() const {
  return implementation_->result().later_run_frames;
}
const std::vector<LoopRecord>& Mapper::loops() const {
  implementation_->wait();
  return implementation_->loops();
}
const KeyframeStore& Mapper::keyframes() const {
  implementation_->wait();
  return implementation_->keyframes();
}
const std::vector<PlacedLocalMap>& Mapper::active_local_maps() const {
  return implementation_->active_local_maps();
}

}  // namespace psi_slam
