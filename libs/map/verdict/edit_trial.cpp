// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/edit_trial.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "logs/frames/pose_operations.h"
#include "logs/frames/pose_tolerance.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Standard deviations of a tried match, small enough to outweigh odometry as a forced loop does.
constexpr double kMatch_m = 0.01;
constexpr double kMatch_rad = 0.003;
/// Views that move by less relative to each other are not compared again.
constexpr PoseTolerance kUnmoved{0.01, 0.002};

bool optimize(PoseGraph& graph) {
  try {
    SparsePoseAdjustment().optimize(graph);
    return true;
  } catch (const UserError&) {
    return false;
  }
}

std::optional<std::size_t> constraint_of(const LoopRecord& loop, const PoseGraph& graph) {
  for (const std::uint32_t index : graph.constraints_of(loop.node)) {
    const Constraint& one = graph.constraint(index);
    if (one.kind == Constraint::Kind::kLoop && one.from == loop.reference && one.to == loop.node &&
        one.from_T_to == loop.reference_T_node)
      return index;
  }
  return std::nullopt;
}

/// Returns the constraint from the node that `earlier` measures, instead of the node where both begin.
Constraint measured_from(const Constraint& earlier, Constraint one) {
  one.from = earlier.to;
  one.from_T_to = between(earlier.from_T_to, one.from_T_to);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotation_matrix(-earlier.from_T_to.phi);
  one.information = Eigen::Matrix3d(turn * one.information * turn.transpose());
  return one;
}

}  // namespace

std::optional<TPose2D> matched_pose(const MapView& view, const MapView& other,
                                    const PassCheckOptions& options) {
  constexpr double kStep_m = 0.5;
  constexpr double kStep_rad = 0.15;
  constexpr int kSteps = 3;
  constexpr int kTurns = 2;
  std::optional<TPose2D> best;
  double most = 0;  // points that fit, without those that are seen through
  MapView start = view;
  for (int turn = -kTurns; turn <= kTurns; ++turn)
    for (int x = -kSteps; x <= kSteps; ++x)
      for (int y = -kSteps; y <= kSteps; ++y) {
        const TPose2D& pose = view.map_T_robot;
        start.map_T_robot = {pose.x + x * kStep_m, pose.y + y * kStep_m,
                             mrpt::math::wrapToPi(pose.phi + turn * kStep_rad)};
        const ScanComparison scans = compare_scans(start, other, options.scans);
        if (!fits_after_alignment(scans, options)) continue;
        const double fitting = static_cast<double>(scans.compared_if_moved) * (2 * scans.same_if_moved - 1);
        if (fitting <= most) continue;
        most = fitting;
        best = scans.map_T_moved;
      }
  return best;
}

EditTrial::EditTrial(const MappingResult& result, const std::vector<MapView>& views,
                     const std::vector<PassCheck>& checks, const PassCheckOptions& options)
    : result_(result), views_(views), checks_(checks), options_(options), settled_(result.graph) {
  if (!optimize(*settled_)) settled_.reset();
}

std::optional<TriedEdit> EditTrial::without_loop(const LoopRecord& loop) const {
  const std::optional<std::size_t> index = constraint_of(loop, result_.graph);
  if (!settled_ || !index || !result_.graph.enabled(*index)) return std::nullopt;
  PoseGraph graph = *settled_;
  graph.set_enabled(*index, false);
  return with_graph(std::move(graph));
}

std::optional<TriedEdit> EditTrial::with_loop(const LoopRecord& loop) const {
  const std::optional<std::size_t> index = constraint_of(loop, result_.graph);
  if (!settled_ || !index || result_.graph.enabled(*index)) return std::nullopt;
  PoseGraph graph = *settled_;
  Constraint forced = graph.constraint(*index);
  forced.kernel = RobustKernel{};
  graph.add_constraint(forced);
  return with_graph(std::move(graph));
}

/// Returns the settled graph with weak path constraints across the frames. Nodes after the frames keep their
/// poses relative to each other: those that one path segment measures hang on the first of them.
PoseGraph EditTrial::loosened(const FrameSpan& doubtful) const {
  constexpr double kWeaker = 1e-4;  // standard deviations 100 times as large
  PoseGraph graph = *settled_;
  std::map<std::size_t, Constraint> first_after;  // of each segment, by its first node
  const std::size_t constraints = graph.num_constraints();
  for (std::size_t i = 0; i < constraints; ++i) {
    Constraint one = graph.constraint(i);
    const bool is_path = one.kind == Constraint::Kind::kLocalMap || one.kind == Constraint::Kind::kOdometry;
    if (!is_path || !graph.enabled(i)) continue;
    const auto [from, to] = std::minmax(one.from, one.to);
    if (result_.node_frames[from] >= doubtful.end || result_.node_frames[to] < doubtful.begin) continue;
    graph.set_enabled(i, false);
    const auto earlier = first_after.find(one.from);
    if (earlier != first_after.end() && earlier->second.to != one.to) {
      one = measured_from(earlier->second, one);
    } else {
      if (one.from < one.to && result_.node_frames[to] >= doubtful.end) first_after.emplace(one.from, one);
      one.information *= kWeaker;
    }
    graph.add_constraint(one);
  }
  return graph;
}

std::optional<TriedEdit> EditTrial::with_match(const TriedMatch& match, const FrameSpan& doubtful) const {
  if (!settled_) return std::nullopt;
  PoseGraph graph = loosened(doubtful);
  Constraint constraint;
  constraint.from = match.from;
  constraint.to = match.to;
  constraint.from_T_to = match.from_T_to;
  constraint.kind = Constraint::Kind::kLoop;
  constraint.kernel = RobustKernel{};
  constraint.information.diagonal() << 1 / (kMatch_m * kMatch_m), 1 / (kMatch_m * kMatch_m),
      1 / (kMatch_rad * kMatch_rad);
  graph.add_constraint(constraint);
  return with_graph(std::move(graph));
}

/// Moves the nodes of the map, which were refined after the last optimisation, as the edit moves those of the
/// graph.
std::optional<TriedEdit> EditTrial::with_graph(PoseGraph graph) const {
  if (!optimize(graph)) return std::nullopt;
  TriedEdit tried;
  const auto moved = [&](std::size_t node, const TPose2D& map_T_node) {
    return compose(graph.pose(node), between(settled_->pose(node), map_T_node));
  };
  for (std::size_t node = 0; node < result_.node_frames.size(); ++node) {
    const TPose2D& before = result_.frames[result_.node_frames[node]].map_T_robot;
    const double moved_m = distance_m(before, moved(node, before));
    if (moved_m > tried.effect.moved_m) {
      tried.effect.moved_m = moved_m;
      tried.effect.at = {before.x, before.y};
    }
  }
  std::vector<MapView> views = views_;
  for (MapView& view : views) view.map_T_robot = moved(view.node, view.map_T_robot);
  for (const PassCheck& check : checks_) tried.errors_m.push_back(error_m(check, views));
  return tried;
}

std::optional<double> EditTrial::error_m(const PassCheck& check, const std::vector<MapView>& moved) const {
  const auto apart = [&](const std::vector<MapView>& views) {
    return between(views[check.view].map_T_robot, views[check.other].map_T_robot);
  };
  if (is_same_place(apart(moved), apart(views_), kUnmoved)) return check.error_m;
  const std::optional<PassCheck> again =
      compare_views(moved, check.view, check.other, check.same_pass, options_);
  if (again && again->scene_changed && check.scene_changed) return check.error_m;
  return again ? std::optional(again->error_m) : std::nullopt;
}

}  // namespace psi_slam
