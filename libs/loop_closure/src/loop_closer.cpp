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

// Of the candidates, those that were not matched with just before.
std::vector<LoopCandidate> LoopCloser::due_candidates(std::size_t node, const PlaceMemory& memory,
                                                      const PoseGraph& graph) {
  const double here_m = memory.nodes[node].travelled_m;
  last_attempt_m_.resize(memory.local_maps.size(), -std::numeric_limits<double>::infinity());
  std::vector<LoopCandidate> due;
  for (const LoopCandidate& candidate :
       loop_candidates(node, memory, graph, sigma_of_anchors(node, memory, graph), options_.candidates)) {
    if (here_m - last_attempt_m_[candidate.local_map] < options_.attempt_distance_m) continue;
    last_attempt_m_[candidate.local_map] = here_m;
    due.push_back(candidate);
  }
  return due;
}

LoopCloser::Outcome LoopCloser::close(std::size_t node, const PlaceMemory& memory, const PoseGraph& graph,
                                      const Matcher& matcher, WorkerPool& pool) {
  const std::vector<LoopCandidate> candidates = due_candidates(node, memory, graph);
  const auto wide = [&](const LoopCandidate& candidate) {
    return is_wide(candidate.extent, options_.verification);
  };
  ScanPoints context;
  if (std::any_of(candidates.begin(), candidates.end(), wide))
    context = scan_context(node, memory, options_.context);
  const ScanPoints& scan = *memory.nodes[node].points;

  Outcome outcome;
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
