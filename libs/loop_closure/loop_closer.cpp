// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/portable_math.h"
#include "frames/pose_operations.h"
#include "loop_closure/loop_attempt.h"

namespace psi_slam {
namespace {

// At the beginning of a run whose place is unknown, every second node searches only this many local maps: the
// newest before the interruption. The robot is often still there. The other nodes search all.
constexpr std::size_t kNewestMaps = 2;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// Returns the uncertainty of each local map's anchor relative to the node, in the order of `local_maps`.
std::vector<RelativeUncertainty> relative_to_anchors(std::size_t node,
                                                     const std::vector<std::size_t>& local_maps,
                                                     const KeyframeStore& keyframes, const PoseGraph& graph,
                                                     PathCovarianceSearch& search) {
  PathCovarianceOptions to_anchors;
  for (const std::size_t m : local_maps) to_anchors.targets.push_back(keyframes.local_maps[m].anchor);
  search.run(graph, node, to_anchors);
  std::vector<RelativeUncertainty> uncertainties;
  for (const std::size_t anchor : to_anchors.targets) uncertainties.push_back(search.of(anchor));
  return uncertainties;
}

// Returns the standard deviations of the relative pose of a node and an anchor. The position error includes
// the heading error times the distance between node and anchor.
PositionSigma sigma_of(const RelativeUncertainty& uncertainty, double distance_m) {
  if (!uncertainty.reached) return {kUnknown, kUnknown};
  const double heading = std::sqrt(uncertainty.covariance(2, 2));
  return {portable::hypot(uncertainty.position_sigma_m(), heading * distance_m), heading};
}

}  // namespace

// Returns the local maps of which a node searches some, if its place is unknown.
std::vector<LoopCandidate> LoopCloser::unplaced_candidates(std::size_t node, const KeyframeStore& keyframes,
                                                           const PoseGraph& graph) {
  std::vector<LoopCandidate> maps = whole_map_candidates(node, keyframes, graph, options_.candidates);
  const std::size_t run = keyframes.unplaced.back().begin;
  if (run != unplaced_run_) unplaced_searches_ = 0;
  unplaced_run_ = run;
  const double run_m = keyframes.nodes[node].travelled_m - keyframes.nodes[run].travelled_m;
  if (run_m < options_.candidates.min_travel_m && maps.size() > kNewestMaps && unplaced_searches_++ % 2 == 0)
    maps.erase(maps.begin(), maps.end() - static_cast<std::ptrdiff_t>(kNewestMaps));
  return maps;
}

// Returns all candidates with narrow windows, and at most `wide_searches` candidates with wide windows. If no
// candidate has a narrow window, the wide ones include those of far_candidates(). If the place of the node is
// unknown, the wide ones are those of whole_map_candidates().
std::vector<LoopCandidate> LoopCloser::candidates(std::size_t node, const KeyframeStore& keyframes,
                                                  const PoseGraph& graph) {
  const auto sigmas_of_anchors = [&](const std::vector<std::size_t>& local_maps) {
    const auto uncertainties = relative_to_anchors(node, local_maps, keyframes, graph, search_);
    std::vector<PositionSigma> sigmas;
    for (std::size_t i = 0; i < local_maps.size(); ++i) {
      const mrpt::math::TPose2D anchor_T_node =
          between(graph.pose(keyframes.local_maps[local_maps[i]].anchor), graph.pose(node));
      sigmas.push_back(sigma_of(uncertainties[i], portable::hypot(anchor_T_node.x, anchor_T_node.y)));
    }
    return sigmas;
  };
  const auto chains_to_anchors = [&](const std::vector<std::size_t>& local_maps) {
    std::vector<double> chains_m;
    for (const auto& uncertainty : relative_to_anchors(node, local_maps, keyframes, graph, search_))
      chains_m.push_back(uncertainty.reached ? uncertainty.chain_m : kUnknown);
    return chains_m;
  };
  std::vector<LoopCandidate> chosen =
      loop_candidates(node, keyframes, graph, options_.candidates, sigmas_of_anchors);
  const auto first_wide = std::stable_partition(chosen.begin(), chosen.end(), [&](const LoopCandidate& one) {
    return !is_wide(one.extent, options_.verification);
  });
  std::vector<LoopCandidate> wide(first_wide, chosen.end());
  chosen.erase(first_wide, chosen.end());
  if (is_unplaced(node, keyframes)) {
    wide = unplaced_candidates(node, keyframes, graph);
  } else if (chosen.empty()) {
    const std::vector<LoopCandidate> far =
        far_candidates(node, keyframes, graph, options_.candidates, chains_to_anchors);
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
                                      const PoseGraph& graph, const NodeMatchers& matchers,
                                      WorkerPool& pool) {
  Outcome outcome;
  if (!begins_stretch(node, keyframes.nodes, options_.attempt_distance_m)) return outcome;
  outcome.searched = true;
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
         return attempt_loop(node, wide(candidate) ? context : scan, candidate,
                             least_reported_response(candidate.extent, options_.verification), keyframes,
                             matchers, options_.verification, run_seed_);
       })) {
    outcome.effort += attempt.effort;
    if (attempt.loop) outcome.effort_of[attempt.loop->matcher] += attempt.effort;
    if (attempt.loop && is_wide(attempt.loop->window, options_.verification))
      schedule_.searched(attempt.loop->local_map, attempt.loop->verdict == LoopVerdict::kPending);
    if (attempt.loop) outcome.loops.push_back(*std::move(attempt.loop));
  }
  return outcome;
}

std::optional<LoopRecord> LoopCloser::match(std::size_t node, const LoopCandidate& candidate,
                                            const KeyframeStore& keyframes, const NodeMatchers& matchers,
                                            WorkerPool& pool) const {
  unpack_local_maps(keyframes, {candidate.local_map}, pool);
  const bool wide = is_wide(candidate.extent, options_.verification);
  return attempt_loop(node,
                      wide ? scan_context(node, keyframes, options_.context) : *keyframes.nodes[node].points,
                      candidate, least_response_by_hand(candidate.extent, options_.verification), keyframes,
                      matchers, options_.verification, run_seed_)
      .loop;
}

}  // namespace psi_slam
