// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/graph_builder.h"

#include <algorithm>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "mapping/loop_closure/superseded_maps.h"
#include "mapping/unplaced_runs.h"
#include "pose_graph/information_matrix.h"
#include "pose_graph/placed_covariances.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Standard deviations of a later run's pose before any loop joins the run to the map, see information_of().
// They determine the windows of the first loop searches.
constexpr double kStartSigma_m = 0.3;
constexpr double kStartSigma_rad = radians_from_degrees(3.0L);

// Distance added to the path between two runs. It exceeds every limit along the path, so no search along the
// path crosses from one run to the other.
double between_runs_m(const BackEndOptions& options) {
  return 1 + std::max({options.loop_closure.candidates.min_travel_m, options.loop_closure.context.travel_m,
                       options.loop_closure.attempt_distance_m, options.loop_consensus.memory_m,
                       options.loop_closure.verification.neighbourhood_m});
}

/// Returns the information matrix of node_T_robot. The standard deviations apply to the pose at which the
/// robot was found, which is known best. An error of the start pose moves it like the end of a rigid arm.
Eigen::Matrix3d information_of(const RunStart& start) {
  const double c = portable::cos(start.node_T_robot.phi);
  const double s = portable::sin(start.node_T_robot.phi);
  const TPose2D& arm = start.robot_T_found;
  Eigen::Matrix3d moved = Eigen::Matrix3d::Identity();  // derivative of the found pose by the start pose
  moved(0, 2) = -(s * arm.x + c * arm.y);
  moved(1, 2) = c * arm.x - s * arm.y;
  return moved.transpose() * noisy_information(Eigen::Matrix3d::Zero(), kStartSigma_m, kStartSigma_rad) *
         moved;
}

}  // namespace

GraphBuilder::GraphBuilder(const MapperOptions& options)
    : options_(options),
      back_end_(options.back_end),
      solver_(options.pose_graph),
      keyframes_(make_keyframe_store()) {}

BackEndStep GraphBuilder::add(const TrackedFrame& tracked) {
  BackEndStep done;
  done.frame = tracked.frame;
  done.node = tracked.step.node;
  // The distance of Psi from the start uses the robot's pose as corrected by the loops of earlier frames.
  const TPose2D map_T_robot = compose(map_T_local_, tracked.step.local_T_robot);
  back_end_.move(tracked.odometry_m, {map_T_robot.x, map_T_robot.y});
  done.factor = back_end_.factor();
  if (done.node) {
    add_node(tracked);
    for (const PlacedLocalMap& finished : tracked.step.finished) remember(finished);
    if (options_.close_loops) close_loops(*done.node, done);
    if (!tracked.step.finished.empty()) done.superseded = drop_superseded();
    follow_graph();
    if (options_.estimates_covariance) done.covariance = newest_covariance();
  }
  done.map_T_local = map_T_local_;
  return done;
}

void GraphBuilder::add_node(const TrackedFrame& tracked) {
  remember_node(tracked.step, tracked.frame, keyframes_);
  graph_.add_node(compose(map_T_local_, tracked.step.local_T_robot));
  constrain_to_path(tracked.step, options_.path_noise, keyframes_, graph_);
  if (run_start_) join_run();
}

// Joins the first node of a later run to the map by a weak constraint. The constraint keeps the graph
// connected and determines where loops are searched.
void GraphBuilder::join_run() {
  const std::size_t first = keyframes_.nodes.size() - 1;
  keyframes_.nodes[first].travelled_m =
      keyframes_.nodes[first - 1].travelled_m + between_runs_m(options_.back_end);
  Constraint constraint;
  constraint.from = run_start_->node;
  constraint.to = first;
  constraint.from_T_to = run_start_->node_T_robot;
  constraint.information =
      std::exchange(is_start_provisional_, false)
          ? noisy_information(Eigen::Matrix3d::Zero(), kProvisionalSigma_m, kProvisionalSigma_rad)
          : information_of(*run_start_);
  constraint.kind = Constraint::Kind::kRunStart;
  graph_.add_constraint(constraint);
  run_start_.reset();
}

void GraphBuilder::close_loops(std::size_t node, BackEndStep& done) {
  const std::size_t constraints_before = graph_.num_constraints();
  done.loops = back_end_.close(node, keyframes_, graph_);
  done.joined = place_joined_runs(constraints_before);
  const std::optional<double> ms = back_end_.optimize_if_due(graph_, solver_);
  done.pose_graph_ms = ms.value_or(0);
  if (ms || !done.joined.empty()) done.map_T_node = graph_.poses();
}

// Drops the local maps that later passes supersede. Returns the nodes whose scans are not kept.
std::vector<std::size_t> GraphBuilder::drop_superseded() {
  return drop_local_maps(
      superseded_maps(keyframes_, graph_, options_.back_end.loop_closure.candidates.min_travel_m),
      keyframes_);
}

// Places the unplaced runs that new loops join to the map.
std::vector<std::size_t> GraphBuilder::place_joined_runs(std::size_t first_constraint) {
  std::vector<std::size_t> joined;
  while (const auto run = place_joined_run(first_constraint, keyframes_, graph_))
    joined.push_back(run->interruption);
  return joined;
}

void GraphBuilder::begin_run(const RunStart& start) {
  if (!keyframes_.unplaced.empty())
    keyframes_.unplaced.back().end = std::min(keyframes_.unplaced.back().end, graph_.num_nodes());
  run_start_ = start;
  follow_graph();
}

// Begins a run after an interruption that moved the robot to an unknown place. Whole-map searches look for
// this place.
void GraphBuilder::begin_unplaced_run(std::size_t interruption) {
  const std::size_t node = graph_.num_nodes() - 1;
  is_start_provisional_ = true;
  begin_run({node, between(graph_.pose(node), provisional_start(graph_)), {0, 0, 0}});
  UnplacedRun run;
  run.begin = graph_.num_nodes();
  run.interruption = interruption;
  keyframes_.unplaced.push_back(run);
}

void GraphBuilder::follow_graph() {
  if (run_start_) {
    map_T_local_ = compose(graph_.pose(run_start_->node), run_start_->node_T_robot);
    return;
  }
  const std::size_t newest = graph_.num_nodes() - 1;
  map_T_local_ = compose(graph_.pose(newest), inverse(keyframes_.nodes[newest].local_T_robot));
}

/// Empty if the constraints do not determine the pose of the newest node.
std::optional<NodeCovariance> GraphBuilder::newest_covariance() {
  try {
    const Eigen::Matrix3d& covariance = newest_covariance_.update(graph_);
    return NodeCovariance{graph_.poses().back(), covariance, newest_covariance_.newest_drift(graph_)};
  } catch (const UserError&) {
    newest_covariance_ = {};
    return std::nullopt;
  }
}

GraphBuilder::Edited GraphBuilder::carry_out(const LoopEdit& edit, std::size_t node) {
  using State = LoopEditOutcome::State;
  const LoopPair pair{node, edit.local_map};
  const std::size_t constraints_before = graph_.num_constraints();
  Edited edited;
  switch (edit.kind) {
    case LoopEdit::Kind::kDelete:
      back_end_.ledger().remove(pair, graph_);
      break;
    case LoopEdit::Kind::kForce:
      if (!back_end_.ledger().force(pair, edit.of_final_search, graph_))
        edited.outcome = {State::kWaits, edit.of_final_search
                                             ? "the final search has to find its match again"
                                             : "no match of this scan and local map has been found yet"};
      break;
    case LoopEdit::Kind::kMatch:
      if (!back_end_.match_by_hand(edit, node, keyframes_, graph_))
        edited.outcome = {State::kImpossible, "the scan has no returns to match"};
      break;
    case LoopEdit::Kind::kRestore:
      if (!back_end_.ledger().restore(pair, graph_))
        edited.outcome = {State::kImpossible, "this loop has no edit that could be undone"};
      break;
  }
  if (edited.outcome.state == State::kImpossible) return edited;
  edited.joined = place_joined_runs(constraints_before);
  back_end_.optimize(graph_, solver_);
  newest_covariance_ = {};  // the edit may have removed constraints
  follow_graph();
  return edited;
}

std::vector<UnplacedRun> GraphBuilder::lay_unjoined_aside(const std::vector<UnplacedRun>& runs) {
  std::vector<UnplacedRun> aside = unjoined_runs(runs, graph_);
  lay_aside(aside, keyframes_, graph_);
  return aside;
}

void GraphBuilder::move_to_site() {
  if (known_) known_->move_to_site(graph_);
}

void GraphBuilder::settle_landmarks() {
  if (known_) back_end_.settle(graph_, solver_, &*known_);
}

void GraphBuilder::restore(Checkpoint&& before) {
  known_.reset();
  graph_ = std::move(before.graph);
  back_end_.ledger() = std::move(before.ledger);
  solver_ = std::move(before.solver);
  newest_covariance_ = {};
}

}  // namespace psi_slam
