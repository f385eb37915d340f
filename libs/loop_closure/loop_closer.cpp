// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "loop_closure/loop_attempt.h"

namespace psi_slam {
namespace {

// The node's uncertainty seen from each local map's anchor: heading errors at the node count with the
// distance. Of those that are out of reach it is infinite, which leaves them out of reach.
std::vector<PositionSigma> sigma_of_anchors(std::size_t node, const KeyframeStore& memory,
                                            const PoseGraph& graph, const LoopCandidateOptions& options,
                                            PathCovarianceSearch& search) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  std::vector<PositionSigma> sigma(memory.local_maps.size(), {kUnknown, kUnknown});
  const std::vector<std::size_t> in_reach = local_maps_in_reach(node, memory, graph, options);
  if (in_reach.empty()) return sigma;
  PathCovarianceOptions to_anchors;
  for (const std::size_t m : in_reach) to_anchors.targets.push_back(memory.local_maps[m].anchor);
  search.run(graph, node, to_anchors);
  for (const std::size_t m : in_reach) {
    const std::size_t anchor = memory.local_maps[m].anchor;
    const RelativeUncertainty uncertainty = search.of(anchor);
    if (!uncertainty.reached) continue;  // nothing is known of where the one lies from the other
    const double heading = std::sqrt(uncertainty.covariance(2, 2));
    const mrpt::math::TPose2D between = graph.pose(node) - graph.pose(anchor);
    sigma[m] = {std::hypot(uncertainty.position_sigma_m(), heading * std::hypot(between.x, between.y)),
                heading};
  }
  return sigma;
}

}  // namespace

LoopCloser::Outcome LoopCloser::close(std::size_t node, const KeyframeStore& memory, const PoseGraph& graph,
                                      const ChosenMatcher& matcher, WorkerPool& pool) {
  Outcome outcome;
  if (!begins_stretch(node, memory.nodes, options_.attempt_distance_m)) return outcome;
  const std::vector<LoopCandidate> candidates = loop_candidates(
      node, memory, graph, sigma_of_anchors(node, memory, graph, options_.candidates, search_),
      options_.candidates);
  std::vector<std::size_t> local_maps;
  for (const LoopCandidate& candidate : candidates) local_maps.push_back(candidate.local_map);
  unpack_local_maps(memory, local_maps, pool);
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

std::optional<LoopRecord> LoopCloser::match(std::size_t node, const LoopCandidate& candidate,
                                            const KeyframeStore& memory, const ChosenMatcher& matcher,
                                            WorkerPool& pool) const {
  unpack_local_maps(memory, {candidate.local_map}, pool);
  const bool wide = is_wide(candidate.extent, options_.verification);
  return attempt_loop(node, wide ? scan_context(node, memory, options_.context) : *memory.nodes[node].points,
                      candidate, memory, matcher, options_.verification, run_seed_)
      .loop;
}

}  // namespace psi_slam
