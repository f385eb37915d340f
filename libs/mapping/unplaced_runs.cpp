// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/unplaced_runs.h"

#include <algorithm>
#include <limits>

#include "frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kProvisional_m = 50;
constexpr double kMargin_m = 2;
// Scans reach at most this far beyond a node when runs are laid aside.
constexpr double kFarthestPoint_m = 40;

struct Extent {
  double x_min = std::numeric_limits<double>::infinity();
  double x_max = -std::numeric_limits<double>::infinity();
  double y_min = std::numeric_limits<double>::infinity();
};

void include(std::size_t node, const KeyframeStore& keyframes, const PoseGraph& graph, Extent& extent) {
  const double reach_m = std::min(keyframes.nodes[node].points->farthest_m, kFarthestPoint_m);
  extent.x_min = std::min(extent.x_min, graph.pose(node).x - reach_m);
  extent.x_max = std::max(extent.x_max, graph.pose(node).x + reach_m);
  extent.y_min = std::min(extent.y_min, graph.pose(node).y - reach_m);
}

}  // namespace

TPose2D provisional_start(const PoseGraph& graph) {
  double x_max = 0;
  for (const TPose2D& pose : graph.poses()) x_max = std::max(x_max, pose.x);
  return {x_max + kProvisional_m, 0, 0};
}

bool place_newest_run(std::size_t first_constraint, KeyframeStore& keyframes, PoseGraph& graph) {
  if (keyframes.unplaced.empty()) return false;
  const NodeSpan run = keyframes.unplaced.back();
  for (std::size_t i = first_constraint; i < graph.num_constraints(); ++i) {
    const Constraint& loop = graph.constraints()[i];
    const bool joins = loop.kind == Constraint::Kind::kLoop && loop.from < run.begin && run.begin <= loop.to;
    if (!joins) continue;
    const TPose2D new_T_old = graph.pose(loop.from) + loop.from_T_to + inverse(graph.pose(loop.to));
    for (std::size_t node = run.begin; node < graph.num_nodes(); ++node)
      graph.set_pose(node, new_T_old + graph.pose(node));
    keyframes.unplaced.pop_back();
    return true;
  }
  return false;
}

void lay_unplaced_runs_aside(const KeyframeStore& keyframes, PoseGraph& graph) {
  Extent map;
  for (std::size_t node = 0; node < graph.num_nodes(); ++node)
    if (!is_unplaced(node, keyframes)) include(node, keyframes, graph, map);
  for (const NodeSpan& run : keyframes.unplaced) {
    const std::size_t end = std::min(run.end, graph.num_nodes());
    Extent aside;
    for (std::size_t node = run.begin; node < end; ++node) include(node, keyframes, graph, aside);
    const TPose2D moved(map.x_max + kMargin_m - aside.x_min, map.y_min - aside.y_min, 0);
    for (std::size_t node = run.begin; node < end; ++node) graph.set_pose(node, moved + graph.pose(node));
    if (run.begin < end) map.x_max += kMargin_m + aside.x_max - aside.x_min;
  }
}

}  // namespace psi_slam
