// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "loop_attempt.h"
#include "psi_slam/pose_graph/path_covariance.h"

namespace psi_slam {
namespace {

// The node's uncertainty seen from each local map's anchor: heading errors at the node count with the
// distance.
std::vector<PositionSigma> sigma_of_anchors(std::size_t node, const PlaceMemory& memory,
                                            const PoseGraph& graph) {
  const std::vector<RelativeUncertainty> uncertainties = path_covariances(graph, node);
  std::vector<PositionSigma> sigma;
  for (const PlacedLocalMap& local_map : memory.local_maps) {
    const RelativeUncertainty& anchor = uncertainties[local_map.anchor];
    if (!anchor.reached) {  // nothing is known of where the one lies from the other
      sigma.push_back({std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()});
      continue;
    }
    const double heading = std::sqrt(anchor.covariance(2, 2));
    const mrpt::math::TPose2D between = graph.pose(node) - graph.pose(local_map.anchor);
    sigma.push_back(
        {std::hypot(anchor.position_sigma_m(), heading * std::hypot(between.x, between.y)), heading});
  }
  return sigma;
}

}  // namespace

LoopCloser::Outcome LoopCloser::close(std::size_t node, const PlaceMemory& memory, const PoseGraph& graph,
                                      const Matcher& matcher, WorkerPool& pool) const {
  Outcome outcome;
  if (!begins_stretch(node, memory.nodes, options_.attempt_distance_m)) return outcome;
  const std::vector<LoopCandidate> candidates =
      loop_candidates(node, memory, graph, sigma_of_anchors(node, memory, graph), options_.candidates);
  const auto wide = [&](const LoopCandidate& candidate) {
    return is_wide(candidate.extent, options_.verification);
  };
  ScanPoints context;
  if (std::any_of(candidates.begin(), candidates.end(), wide))
    context = scan_context(node, memory, options_.context);
  const ScanPoints& scan = *memory.nodes[node].points;

  for (LoopAttempt& attempt : map_in_parallel<LoopAttempt>(pool, candidates.size(), [&](std::size_t index) {
         const LoopCandidate& candidate = candidates[index];
         return attempt_loop(node, wide(candidate) ? context : scan, candidate, memory, matcher,
                             options_.verification, run_seed_);
       })) {
    outcome.effort += attempt.effort;
    if (attempt.loop) outcome.loops.push_back(*std::move(attempt.loop));
  }
  return outcome;
}

}  // namespace psi_slam
