// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/loop_closer.h"

#include <chrono>
#include <cmath>
#include <limits>

#include "psi_slam/pose_graph/path_covariance.h"

namespace psi_slam {
namespace {

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// The node's uncertainty seen from each local map's anchor: heading errors at the node count with the
// distance.
std::vector<PositionSigma> sigma_of_anchors(std::size_t node, const PlaceMemory& memory,
                                            const PoseGraph& graph) {
  const std::vector<RelativeUncertainty> uncertainties = path_covariances(graph, node);
  std::vector<PositionSigma> sigma;
  for (const PlacedLocalMap& local_map : memory.local_maps) {
    const RelativeUncertainty& anchor = uncertainties[local_map.anchor];
    const double heading = std::sqrt(anchor.covariance(2, 2));
    const mrpt::math::TPose2D between = graph.pose(node) - graph.pose(local_map.anchor);
    sigma.push_back(
        {std::hypot(anchor.position_sigma_m(), heading * std::hypot(between.x, between.y)), heading});
  }
  return sigma;
}

}  // namespace

std::vector<LoopRecord> LoopCloser::close(std::size_t node, const PlaceMemory& memory, const PoseGraph& graph,
                                          const Matcher& matcher) {
  std::vector<LoopRecord> loops;
  tried_ = 0;
  const NodeScan& here = memory.nodes[node];
  last_attempt_m_.resize(memory.local_maps.size(), -std::numeric_limits<double>::infinity());
  const std::vector<PositionSigma> sigma = sigma_of_anchors(node, memory, graph);
  for (const LoopCandidate& candidate : loop_candidates(node, memory, graph, sigma, options_.candidates)) {
    const PlacedLocalMap& local_map = memory.local_maps[candidate.local_map];
    if (here.travelled_m - last_attempt_m_[candidate.local_map] < options_.attempt_distance_m) continue;
    last_attempt_m_[candidate.local_map] = here.travelled_m;
    ++tried_;

    const auto start = std::chrono::steady_clock::now();
    MatchProblem problem{local_map.map->scores(), *here.points, candidate.anchor_T_node, candidate.extent};
    problem.min_response = 0.8 * options_.verification.min_response;
    problem.measure_ambiguity = true;
    problem.seed = {0, here.frame, local_map.id};
    const MatchResult match = matcher.match(problem);
    if (!match.found) continue;

    LoopRecord loop;
    loop.frame = here.frame;
    loop.node = node;
    loop.local_map = candidate.local_map;
    loop.anchor = local_map.anchor;
    loop.matcher = matcher.name();
    loop.anchor_T_node = match.map_T_robot;
    loop.covariance = match.covariance;
    loop.window = candidate.extent;
    loop.response = match.response;
    loop.ambiguity = match.ambiguity.value_or(0);
    loop.moved_m = std::hypot(match.map_T_robot.x - candidate.anchor_T_node.x,
                              match.map_T_robot.y - candidate.anchor_T_node.y);
    loop.evaluations = match.evaluations;
    verify(loop, memory, options_.verification);
    loop.milliseconds = milliseconds_since(start);
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace psi_slam
