// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "loop_closure/loop_attempt.h"

namespace psi_slam {
namespace {

// Returns the uncertainty of the node relative to the anchors of local maps. The position sigma includes the
// heading sigma, multiplied by the distance.
std::vector<PositionSigma> sigmas_of_anchors(std::size_t node, const std::vector<std::size_t>& local_maps,
                                             const KeyframeStore& keyframes, const PoseGraph& graph,
                                             PathCovarianceSearch& search) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  PathCovarianceOptions to_anchors;
  for (const std::size_t m : local_maps) to_anchors.targets.push_back(keyframes.local_maps[m].anchor);
  search.run(graph, node, to_anchors);
  std::vector<PositionSigma> sigmas;
  for (const std::size_t anchor : to_anchors.targets) {
    PositionSigma& sigma = sigmas.emplace_back(PositionSigma{kUnknown, kUnknown});
    const RelativeUncertainty uncertainty = search.of(anchor);
    if (!uncertainty.reached) continue;
    const double heading = std::sqrt(uncertainty.covariance(2, 2));
    const mrpt::math::TPose2D between = graph.pose(node) - graph.pose(anchor);
    sigma = {std::hypot(uncertainty.position_sigma_m(), heading * std::hypot(between.x, between.y)), heading};
  }
  return sigmas;
}

// Lengths of the chains of constraints from the node to the local maps' anchors.
std::vector<double> chains_to_anchors(std::size_t node, const std::vector<std::size_t>& local_maps,
                                      const KeyframeStore& keyframes, const PoseGraph& graph,
                                      PathCovarianceSearch& search) {
  PathCovarianceOptions to_anchors;
  for (const std::size_t m : local_maps) to_anchors.targets.push_back(keyframes.local_maps[m].anchor);
  search.run(graph, node, to_anchors);
  std::vector<double> chains_m;
  for (const std::size_t anchor : to_anchors.targets) {
    const RelativeUncertainty uncertainty = search.of(anchor);
    chains_m.push_back(uncertainty.reached ? uncertainty.chain_m : std::numeric_limits<double>::infinity());
  }
  return chains_m;
}

}  // namespace

// Returns all candidates with narrow windows, and as many of the others as a node may search. If no candidate
// has a narrow window, the others include whole local maps within the drift.
std::vector<LoopCandidate> LoopCloser::candidates(std::size_t node, const KeyframeStore& keyframes,
                                                  const PoseGraph& graph) {
  std::vector<LoopCandidate> chosen =
      loop_candidates(node, keyframes, graph, options_.candidates, [&](const std::vector<std::size_t>& near) {
        return sigmas_of_anchors(node, near, keyframes, graph, search_);
      });
  const auto first_wide = std::stable_partition(chosen.begin(), chosen.end(), [&](const LoopCandidate& one) {
    return !is_wide(one.extent, options_.verification);
  });
  std::vector<LoopCandidate> wide(first_wide, chosen.end());
  chosen.erase(first_wide, chosen.end());
  if (chosen.empty()) {
    const std::vector<LoopCandidate> far = far_candidates(
        node, keyframes, graph, options_.candidates, [&](const std::vector<std::size_t>& local_maps) {
          return chains_to_anchors(node, local_maps, keyframes, graph, search_);
        });
    const auto is_far = [&](const LoopCandidate& one) {
      return std::any_of(far.begin(), far.end(),
                         [&](const LoopCandidate& other) { return other.local_map == one.local_map; });
    };
    wide.erase(std::remove_if(wide.begin(), wide.end(), is_far), wide.end());
    wide.insert(wide.end(), far.begin(), far.end());
  }
  for (const LoopCandidate& one : schedule_.choose(std::move(wide), options_.wide_searches))
    chosen.push_back(one);
  std::sort(chosen.begin(), chosen.end(),
            [](const LoopCandidate& a, const LoopCandidate& b) { return a.local_map < b.local_map; });
  return chosen;
}

LoopCloser::Outcome LoopCloser::close(std::size_t node, const KeyframeStore& keyframes,
                                      const PoseGraph& graph, const ChosenMatcher& matcher,
                                      WorkerPool& pool) {
  Outcome outcome;
  if (!begins_stretch(node, keyframes.nodes, options_.attempt_distance_m)) return outcome;
  const std::vector<LoopCandidate> candidates = this->candidates(node, keyframes, graph);
  std::vector<std::size_t> local_maps;
  for (const LoopCandidate& candidate : candidates) local_maps.push_back(candidate.local_map);
  unpack_local_maps(keyframes, local_maps, pool);
  const auto wide = [&](const LoopCandidate& candidate) {
    return is_wide(candidate.extent, options_.verification);
  };
  ScanPoints context;
  if (std::any_of(candidates.begin(), candidates.end(), wide))
    context = scan_context(node, keyframes, options_.context);
  const ScanPoints& scan = *keyframes.nodes[node].points;

  for (LoopAttempt& attempt : map_in_parallel<LoopAttempt>(pool, candidates.size(), [&](std::size_t index) {
         const LoopCandidate& candidate = candidates[index];
         return attempt_loop(node, wide(candidate) ? context : scan, candidate, keyframes, matcher,
                             options_.verification, run_seed_);
       })) {
    outcome.effort += attempt.effort;
    if (attempt.loop && is_wide(attempt.loop->window, options_.verification))
      schedule_.searched(attempt.loop->local_map, attempt.loop->verdict == LoopVerdict::kPending);
    if (attempt.loop) outcome.loops.push_back(*std::move(attempt.loop));
  }
  return outcome;
}

std::optional<LoopRecord> LoopCloser::match(std::size_t node, const LoopCandidate& candidate,
                                            const KeyframeStore& keyframes, const ChosenMatcher& matcher,
                                            WorkerPool& pool) const {
  unpack_local_maps(keyframes, {candidate.local_map}, pool);
  const bool wide = is_wide(candidate.extent, options_.verification);
  return attempt_loop(node,
                      wide ? scan_context(node, keyframes, options_.context) : *keyframes.nodes[node].points,
                      candidate, keyframes, matcher, options_.verification, run_seed_)
      .loop;
}

}  // namespace psi_slam
