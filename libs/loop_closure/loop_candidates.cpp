// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/loop_candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace psi_slam {
namespace {

double nearest_node_m(const PlacedLocalMap& local_map, const mrpt::math::TPose2D& map_T_node,
                      const PoseGraph& graph) {
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (std::size_t other = local_map.first_node; other <= local_map.last_node; ++other) {
    const double dx = graph.pose(other).x - map_T_node.x;
    const double dy = graph.pose(other).y - map_T_node.y;
    nearest_squared = std::min(nearest_squared, dx * dx + dy * dy);
  }
  return std::sqrt(nearest_squared);
}

double travel_between_m(std::size_t node, const PlacedLocalMap& local_map, const KeyframeStore& memory) {
  if (node > local_map.last_node)
    return memory.nodes[node].travelled_m - memory.nodes[local_map.last_node].travelled_m;
  if (node < local_map.first_node)
    return memory.nodes[local_map.first_node].travelled_m - memory.nodes[node].travelled_m;
  return 0;
}

}  // namespace

std::vector<std::size_t> local_maps_in_reach(std::size_t node, const KeyframeStore& memory,
                                             const PoseGraph& graph, const LoopCandidateOptions& options) {
  const double reach_m =
      options.reach_m + std::max({options.max_window.x_m, options.max_window.y_m, options.min_window_m});
  std::vector<std::size_t> in_reach;
  for (std::size_t m = 0; m < memory.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = memory.local_maps[m];
    if (travel_between_m(node, local_map, memory) >= options.min_travel_m &&
        nearest_node_m(local_map, graph.pose(node), graph) <= reach_m)
      in_reach.push_back(m);
  }
  return in_reach;
}

std::vector<LoopCandidate> loop_candidates(std::size_t node, const KeyframeStore& memory,
                                           const PoseGraph& graph,
                                           const std::vector<PositionSigma>& sigma_of_anchor,
                                           const LoopCandidateOptions& options) {
  std::vector<LoopCandidate> candidates;
  const mrpt::math::TPose2D& map_T_node = graph.pose(node);
  for (std::size_t m = 0; m < memory.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = memory.local_maps[m];
    if (travel_between_m(node, local_map, memory) < options.min_travel_m) continue;
    const auto half_width = [&](double sigma, double least, double most) {
      return std::clamp(options.window_sigmas * sigma, least, most);
    };
    const PositionSigma& sigma = sigma_of_anchor[m];
    const SearchExtent extent = {
        half_width(sigma.metres, options.min_window_m, options.max_window.x_m),
        half_width(sigma.metres, options.min_window_m, options.max_window.y_m),
        half_width(sigma.radians, options.min_window_rad, options.max_window.theta_rad)};
    const double distance_m = nearest_node_m(local_map, map_T_node, graph);
    if (distance_m > options.reach_m + std::max(extent.x_m, extent.y_m)) continue;
    LoopCandidate candidate;
    candidate.local_map = m;
    candidate.anchor_T_node = map_T_node - graph.pose(local_map.anchor);
    candidate.distance_m = distance_m;
    candidate.extent = extent;
    candidates.push_back(candidate);
  }
  return candidates;
}

}  // namespace psi_slam
