// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_attempt.h"

#include <chrono>
#include <utility>

#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

// Returns whether a scan has a point farther than one cell from the robot. make_search_window() throws if all
// points are within half a cell.
bool can_be_searched(const ScanPoints& scan, const PlacedLocalMap& local_map) {
  return !scan.points.empty() && scan.farthest_m > std::as_const(*local_map.map).scores().resolution_m();
}

}  // namespace

LoopAttempt attempt_loop(std::size_t node, const ScanPoints& scan, const LoopCandidate& candidate,
                         double least_response, const KeyframeStore& keyframes, const NodeMatchers& matchers,
                         const LoopVerificationOptions& verification, std::uint64_t run_seed) {
  LoopAttempt attempt;
  const NodeScan& here = keyframes.nodes[node];
  const PlacedLocalMap& local_map = keyframes.local_maps[candidate.local_map];
  if (!can_be_searched(scan, local_map)) return attempt;
  MatchProblem problem{std::as_const(*local_map.map).scores(), scan, candidate.anchor_T_node,
                       candidate.extent};
  problem.min_response = least_response;
  problem.measure_ambiguity = true;
  problem.seed = {run_seed, here.frame, local_map.id};
  const ChosenMatcher& matcher =
      matchers.in(make_search_window(problem.extent, problem.grid.resolution_m(), scan.farthest_m));
  const auto start = std::chrono::steady_clock::now();
  const MatchResult match = matcher.matcher.match(problem);
  const auto time = std::chrono::steady_clock::now() - start;
  const double milliseconds = std::chrono::duration<double, std::milli>(time).count();
  attempt.effort.add(match.search, {1, match.found ? std::size_t{1} : 0, match.evaluations, milliseconds});

  LoopRecord& loop = attempt.loop.emplace();
  loop.frame = here.frame;
  loop.node = node;
  loop.local_map = candidate.local_map;
  loop.anchor = local_map.anchor;
  loop.matcher = matcher.kind;
  loop.search = match.search;
  loop.anchor_T_predicted = candidate.anchor_T_node;
  loop.window = candidate.extent;
  loop.evaluations = match.evaluations;
  loop.milliseconds = milliseconds;
  if (!match.found) {
    loop.anchor_T_node = candidate.anchor_T_node;
    reject(loop, {LoopRejection::Reason::kNothingFound, 0, problem.min_response});
    return attempt;
  }
  loop.anchor_T_node = match.map_T_robot;
  set_reference(loop, keyframes);
  loop.covariance = match.covariance;
  loop.response = match.response;
  loop.ambiguity = match.ambiguity.value_or(0);
  loop.moved_m = distance_m(candidate.anchor_T_node, match.map_T_robot);
  loop.prior = path_prior(distance_m(candidate.anchor_T_predicted, match.map_T_robot), candidate.sigma_m);
  verify(loop, scan, keyframes, verification);
  return attempt;
}

}  // namespace psi_slam
