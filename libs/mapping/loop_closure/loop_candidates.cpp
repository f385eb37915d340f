// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

struct NearestNode {
  double distance_m = std::numeric_limits<double>::infinity();
  std::size_t segment = 0;  ///< first node of its path segment
};

NearestNode nearest_node(const PlacedLocalMap& local_map, const mrpt::math::TPose2D& map_T_node,
                         const KeyframeStore& keyframes, const PoseGraph& graph) {
  double nearest_squared = std::numeric_limits<double>::infinity();
  std::size_t nearest = local_map.anchor;
  for (std::size_t other = local_map.first_node; other <= local_map.last_node; ++other) {
    const double dx = graph.pose(other).x - map_T_node.x;
    const double dy = graph.pose(other).y - map_T_node.y;
    if (dx * dx + dy * dy >= nearest_squared) continue;
    nearest_squared = dx * dx + dy * dy;
    nearest = other;
  }
  return {std::sqrt(nearest_squared), keyframes.nodes[nearest].segment};
}

double travel_between_m(std::size_t node, const PlacedLocalMap& local_map, const KeyframeStore& keyframes) {
  if (node > local_map.last_node)
    return keyframes.nodes[node].travelled_m - keyframes.nodes[local_map.last_node].travelled_m;
  if (node < local_map.first_node)
    return keyframes.nodes[local_map.first_node].travelled_m - keyframes.nodes[node].travelled_m;
  return 0;
}

SearchExtent window_of(const PositionSigma& sigma, const LoopCandidateOptions& options) {
  const auto half_width = [&](double deviation, double least, double most) {
    return std::clamp(options.window_sigmas * deviation, least, most);
  };
  return {half_width(sigma.metres, options.min_window_m, options.max_window.x_m),
          half_width(sigma.metres, options.min_window_m, options.max_window.y_m),
          half_width(sigma.radians, options.min_window_rad, options.max_window.theta_rad)};
}

// Returns a candidate whose window holds all positions within reach_m of the local map's nodes.
LoopCandidate whole_local_map(std::size_t m, const mrpt::math::TPose2D& map_T_node,
                              const KeyframeStore& keyframes, const PoseGraph& graph,
                              const LoopCandidateOptions& options) {
  const PlacedLocalMap& local_map = keyframes.local_maps[m];
  const mrpt::math::TPose2D& map_T_anchor = graph.pose(local_map.anchor);
  double x_min = 0, x_max = 0, y_min = 0, y_max = 0;
  for (std::size_t other = local_map.first_node; other <= local_map.last_node; ++other) {
    const mrpt::math::TPose2D anchor_T_other = between(map_T_anchor, graph.pose(other));
    x_min = std::min(x_min, anchor_T_other.x);
    x_max = std::max(x_max, anchor_T_other.x);
    y_min = std::min(y_min, anchor_T_other.y);
    y_max = std::max(y_max, anchor_T_other.y);
  }
  LoopCandidate candidate;
  candidate.local_map = m;
  candidate.anchor_T_predicted = between(map_T_anchor, map_T_node);
  candidate.anchor_T_node = {0.5 * (x_min + x_max), 0.5 * (y_min + y_max), candidate.anchor_T_predicted.phi};
  candidate.extent = {0.5 * (x_max - x_min) + options.reach_m, 0.5 * (y_max - y_min) + options.reach_m,
                      options.max_window.theta_rad};
  return candidate;
}

}  // namespace

double path_prior(double moved_m, double sigma_m) {
  constexpr double kWidth = 2.5;
  const double off = moved_m / (kWidth * sigma_m);
  return portable::exp(-off * off / 2);
}

std::vector<LoopCandidate> loop_candidates(std::size_t node, const KeyframeStore& keyframes,
                                           const PoseGraph& graph, const LoopCandidateOptions& options,
                                           const SigmasOfNodes& sigmas_of_nodes) {
  const mrpt::math::TPose2D& map_T_node = graph.pose(node);
  const double reach_m =
      options.reach_m + std::max({options.max_window.x_m, options.max_window.y_m, options.min_window_m});
  std::vector<LoopCandidate> in_reach;
  std::vector<std::size_t> segments;
  for (std::size_t m = 0; m < keyframes.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = keyframes.local_maps[m];
    if (local_map.is_superseded || !are_joined(node, local_map.first_node, keyframes)) continue;
    if (travel_between_m(node, local_map, keyframes) < options.min_travel_m) continue;
    const NearestNode nearest = nearest_node(local_map, map_T_node, keyframes, graph);
    if (nearest.distance_m > reach_m) continue;
    LoopCandidate& candidate = in_reach.emplace_back();
    candidate.local_map = m;
    candidate.anchor_T_node = candidate.anchor_T_predicted =
        between(graph.pose(local_map.anchor), map_T_node);
    candidate.distance_m = nearest.distance_m;
    segments.push_back(nearest.segment);
  }
  if (in_reach.empty()) return {};

  const std::vector<PositionSigma> sigmas = sigmas_of_nodes(segments);
  std::vector<LoopCandidate> candidates;
  for (std::size_t i = 0; i < in_reach.size(); ++i) {
    LoopCandidate candidate = in_reach[i];
    candidate.extent = window_of(sigmas[i], options);
    candidate.sigma_m = std::max(sigmas[i].metres, options.min_window_m / options.window_sigmas);
    if (candidate.distance_m <= options.reach_m + std::max(candidate.extent.x_m, candidate.extent.y_m))
      candidates.push_back(candidate);
  }
  return candidates;
}

std::vector<LoopCandidate> far_candidates(std::size_t node, const KeyframeStore& keyframes,
                                          const PoseGraph& graph, const LoopCandidateOptions& options,
                                          const SigmasOfNodes& sigmas_of_nodes) {
  const mrpt::math::TPose2D& map_T_node = graph.pose(node);
  const double largest_window_m = std::max(options.max_window.x_m, options.max_window.y_m);
  std::vector<std::size_t> local_maps;
  std::vector<std::size_t> segments;
  std::vector<double> distances_m;
  for (std::size_t m = 0; m < keyframes.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = keyframes.local_maps[m];
    if (local_map.is_superseded || !are_joined(node, local_map.first_node, keyframes)) continue;
    if (travel_between_m(node, local_map, keyframes) < options.min_travel_m) continue;
    local_maps.push_back(m);
    const NearestNode nearest = nearest_node(local_map, map_T_node, keyframes, graph);
    segments.push_back(nearest.segment);
    distances_m.push_back(nearest.distance_m);
  }
  if (local_maps.empty()) return {};

  const std::vector<PositionSigma> sigmas = sigmas_of_nodes(segments);
  std::vector<LoopCandidate> candidates;
  for (std::size_t i = 0; i < local_maps.size(); ++i) {
    const double drift_m = options.window_sigmas * sigmas[i].metres;
    if (drift_m <= largest_window_m || distances_m[i] > drift_m + options.reach_m) continue;
    candidates.push_back(whole_local_map(local_maps[i], map_T_node, keyframes, graph, options));
    candidates.back().distance_m = distances_m[i];
    candidates.back().sigma_m = sigmas[i].metres;
  }
  return candidates;
}

std::vector<LoopCandidate> whole_map_candidates(std::size_t node, const KeyframeStore& keyframes,
                                                const PoseGraph& graph, const LoopCandidateOptions& options) {
  std::vector<LoopCandidate> candidates;
  for (std::size_t m = 0; m < keyframes.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = keyframes.local_maps[m];
    if (local_map.is_superseded || is_unplaced(local_map.first_node, keyframes)) continue;
    candidates.push_back(whole_local_map(m, graph.pose(node), keyframes, graph, options));
    candidates.back().extent.theta_rad = M_PI;
  }
  return candidates;
}

}  // namespace psi_slam
