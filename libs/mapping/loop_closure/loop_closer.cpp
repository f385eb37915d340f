// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "mapping/loop_closure/loop_attempt.h"

namespace psi_slam {
namespace {

// At the beginning of a run whose place is unknown, every second node searches only this many local maps: the
// newest before the interruption. The robot is often still there. The other nodes search all.
constexpr std::size_t kNewestMaps = 2;

// Largest number of searches in wide windows that are made up for a node at the end of a log.
constexpr std::size_t kMostMadeUp = 8;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// Returns the standard deviations of the relative pose of two nodes. The position error includes the heading
// error times the distance between them.
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

// Returns the candidates with narrow and with wide windows. If no candidate has a narrow window, the wide
// ones include those of far_candidates(). If the place of the node is unknown, the wide ones are those of
// whole_map_candidates().
LoopCloser::Candidates LoopCloser::candidates(std::size_t node, const KeyframeStore& keyframes,
                                              const PoseGraph& graph) {
  const auto sigmas_of_nodes = [&](const std::vector<std::size_t>& others) {
    PathCovarianceOptions to_others;
    to_others.with_doubt = true;
    to_others.targets = others;
    search_.run(graph, node, to_others);
    std::vector<PositionSigma> sigmas;
    for (const std::size_t other : others)
      sigmas.push_back(sigma_of(search_.of(other), distance_m(graph.pose(other), graph.pose(node))));
    return sigmas;
  };
  std::vector<LoopCandidate> chosen =
      loop_candidates(node, keyframes, graph, options_.candidates, sigmas_of_nodes);
  const auto first_wide = std::stable_partition(chosen.begin(), chosen.end(), [&](const LoopCandidate& one) {
    return !is_wide(one.extent, options_.verification);
  });
  std::vector<LoopCandidate> wide(first_wide, chosen.end());
  chosen.erase(first_wide, chosen.end());
  if (is_unplaced(node, keyframes)) {
    wide = unplaced_candidates(node, keyframes, graph);
  } else if (chosen.empty()) {
    const std::vector<LoopCandidate> far =
        far_candidates(node, keyframes, graph, options_.candidates, sigmas_of_nodes);
    const auto is_far = [&](const LoopCandidate& one) {
      return std::any_of(far.begin(), far.end(),
                         [&](const LoopCandidate& other) { return other.local_map == one.local_map; });
    };
    wide.erase(std::remove_if(wide.begin(), wide.end(), is_far), wide.end());
    wide.insert(wide.end(), far.begin(), far.end());
  }
  return {std::move(chosen), std::move(wide)};
}

// Searches all narrow windows, and at most `wide_searches` wide ones.
LoopCloser::Outcome LoopCloser::close(std::size_t node, const KeyframeStore& keyframes,
                                      const PoseGraph& graph, const NodeMatchers& matchers,
                                      WorkerPool& pool) {
  Outcome outcome;
  if (!begins_stretch(node, keyframes.nodes, options_.attempt_distance_m)) return outcome;
  outcome.searched = true;
  auto [chosen, wide] = this->candidates(node, keyframes, graph);
  for (const LoopCandidate& one : schedule_.choose(std::move(wide), options_.wide_searches))
    chosen.push_back(one);
  std::sort(chosen.begin(), chosen.end(),
            [](const LoopCandidate& a, const LoopCandidate& b) { return a.local_map < b.local_map; });
  match_all(node, chosen, keyframes, matchers, pool, outcome);
  for (const LoopRecord& loop : outcome.loops)
    if (is_wide(loop.window, options_.verification))
      schedule_.searched(loop.local_map, loop.state == LoopState::kCandidate);
  return outcome;
}

LoopCloser::Outcome LoopCloser::close_wide(std::size_t node, const KeyframeStore& keyframes,
                                           const PoseGraph& graph, const NodeMatchers& matchers,
                                           WorkerPool& pool,
                                           const std::function<bool(std::size_t)>& is_known) {
  Outcome outcome;
  if (!begins_stretch(node, keyframes.nodes, options_.attempt_distance_m)) return outcome;
  std::vector<LoopCandidate> wide = this->candidates(node, keyframes, graph).wide;
  wide.erase(std::remove_if(wide.begin(), wide.end(),
                            [&](const LoopCandidate& one) { return is_known(one.local_map); }),
             wide.end());
  match_all(node, schedule_.choose(std::move(wide), kMostMadeUp), keyframes, matchers, pool, outcome);
  return outcome;
}

// Matches a node with its candidates, several in parallel, and adds the attempts to `outcome`.
void LoopCloser::match_all(std::size_t node, const std::vector<LoopCandidate>& candidates,
                           const KeyframeStore& keyframes, const NodeMatchers& matchers, WorkerPool& pool,
                           Outcome& outcome) const {
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
    if (attempt.loop) outcome.loops.push_back(*std::move(attempt.loop));
  }
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
