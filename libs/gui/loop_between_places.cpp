// SPDX-License-Identifier: BSD-3-Clause
#include "gui/loop_between_places.h"

#include <algorithm>
#include <limits>

#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kNear_m = 2;

/// Distance of a node from a place, in metres; all distances below kNear_m count as kNear_m.
double rounded_distance_m(const TPose2D& node, const TPoint2D& place) {
  return std::max(kNear_m, distance_m(place, node));
}

std::size_t newest_node_near(const std::vector<TPose2D>& map_T_node, const TPoint2D& place) {
  std::size_t newest = 0;
  for (std::size_t node = 1; node < map_T_node.size(); ++node)
    if (rounded_distance_m(map_T_node[node], place) <= rounded_distance_m(map_T_node[newest], place))
      newest = node;
  return newest;
}

std::optional<std::size_t> oldest_local_map_near(const ReplaySnapshot& snapshot, std::size_t excluded_node,
                                                 const TPoint2D& place) {
  std::optional<std::size_t> oldest;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < snapshot.local_maps.size(); ++m) {
    const LocalMapRecord& map = snapshot.local_maps[m];
    if (excluded_node >= map.first_node && excluded_node <= map.last_node) continue;
    for (std::size_t node = map.first_node; node <= map.last_node; ++node) {
      const double distance_m = rounded_distance_m(snapshot.map_T_node->at(node), place);
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      oldest = m;
    }
  }
  return oldest;
}

}  // namespace

std::optional<LoopEdit> loop_between_places(const ReplaySnapshot& snapshot, const TPoint2D& seen_by_scan,
                                            const TPoint2D& in_local_map, MatcherKind matcher) {
  const std::vector<TPose2D>& map_T_node = *snapshot.map_T_node;
  if (map_T_node.empty()) return std::nullopt;
  const std::size_t node = newest_node_near(map_T_node, seen_by_scan);
  const auto local_map = oldest_local_map_near(snapshot, node, in_local_map);
  if (!local_map) return std::nullopt;
  const TPose2D& map_T_scan = map_T_node[node];
  const TPoint2D shift = in_local_map - seen_by_scan;
  const TPose2D map_T_expected(map_T_scan.x + shift.x, map_T_scan.y + shift.y, map_T_scan.phi);
  LoopEdit edit{LoopEdit::Kind::kMatch, snapshot.nodes[node].frame, *local_map};
  edit.matcher = matcher;
  edit.place = LoopPlace{between(map_T_node[snapshot.local_maps[*local_map].anchor], map_T_expected),
                         {kClickedWindow_m, kClickedWindow_m, kClickedWindow_rad}};
  return edit;
}

}  // namespace psi_slam
