// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/unplaced_runs.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "logs/frames/pose_operations.h"

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
  const auto& points = keyframes.nodes[node].points;
  const double reach_m = points ? std::min(points->farthest_m, kFarthestPoint_m) : 0;
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

std::optional<UnplacedRun> place_joined_run(std::size_t first_constraint, KeyframeStore& keyframes,
                                            PoseGraph& graph) {
  for (std::size_t i = first_constraint; i < graph.num_constraints(); ++i) {
    const Constraint& loop = graph.constraints()[i];
    const bool from_unplaced = is_unplaced(loop.from, keyframes);
    const bool joins =
        loop.kind == Constraint::Kind::kLoop && from_unplaced != is_unplaced(loop.to, keyframes);
    if (!joins) continue;
    const std::size_t moved = from_unplaced ? loop.from : loop.to;
    const TPose2D map_T_moved = from_unplaced ? compose(graph.pose(loop.to), inverse(loop.from_T_to))
                                              : compose(graph.pose(loop.from), loop.from_T_to);
    const auto found = std::find_if(keyframes.unplaced.begin(), keyframes.unplaced.end(),
                                    [&](const UnplacedRun& one) { return one.contains(moved); });
    const UnplacedRun run = *found;
    const TPose2D new_T_old = compose(map_T_moved, inverse(graph.pose(moved)));
    for (std::size_t node = run.begin; node < std::min(run.end, graph.num_nodes()); ++node)
      graph.set_pose(node, compose(new_T_old, graph.pose(node)));
    keyframes.unplaced.erase(found);
    return run;
  }
  return std::nullopt;
}

std::vector<UnplacedRun> unjoined_runs(const std::vector<UnplacedRun>& runs, const PoseGraph& graph) {
  // Group of each run, and of all other nodes as the last element: the number of a run that it is joined to.
  std::vector<std::size_t> group(runs.size() + 1);
  std::iota(group.begin(), group.end(), 0U);
  const auto run_of = [&](std::size_t node) {
    return static_cast<std::size_t>(
        std::find_if(runs.begin(), runs.end(), [&](const UnplacedRun& run) { return run.contains(node); }) -
        runs.begin());
  };
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    const Constraint& loop = graph.constraints()[i];
    if (loop.kind != Constraint::Kind::kLoop || !graph.enabled(i)) continue;
    const auto [low, high] = std::minmax({group[run_of(loop.from)], group[run_of(loop.to)]});
    std::replace(group.begin(), group.end(), low, high);
  }
  std::vector<UnplacedRun> unjoined;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (group[i] != group.back()) unjoined.push_back(runs[i]);
  return unjoined;
}

void lay_aside(const std::vector<UnplacedRun>& runs, const KeyframeStore& keyframes, PoseGraph& graph) {
  const auto is_aside = [&](std::size_t node) {
    return std::any_of(runs.begin(), runs.end(), [&](const UnplacedRun& run) { return run.contains(node); });
  };
  Extent map;
  for (std::size_t node = 0; node < keyframes.nodes.size(); ++node)
    if (!is_aside(node)) include(node, keyframes, graph, map);
  for (const UnplacedRun& run : runs) {
    const std::size_t end = std::min(run.end, keyframes.nodes.size());
    Extent aside;
    for (std::size_t node = run.begin; node < end; ++node) include(node, keyframes, graph, aside);
    const TPose2D moved(map.x_max + kMargin_m - aside.x_min, map.y_min - aside.y_min, 0);
    for (std::size_t node = run.begin; node < end; ++node)
      graph.set_pose(node, compose(moved, graph.pose(node)));
    map.x_max += kMargin_m + aside.x_max - aside.x_min;
  }
}

}  // namespace psi_slam
