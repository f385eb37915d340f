// SPDX-License-Identifier: BSD-3-Clause
#include "loop_attempt.h"

#include <chrono>
#include <cmath>
#include <utility>

namespace psi_slam {
namespace {

// A blind scan has no points, or none that a turn would move (see make_search_window).
bool can_be_searched(const ScanPoints& scan, const PlacedLocalMap& local_map) {
  return !scan.points.empty() && scan.farthest_m > std::as_const(*local_map.map).scores().resolution_m();
}

}  // namespace

std::optional<LoopRecord> attempt_loop(std::size_t node, const ScanPoints& scan,
                                       const LoopCandidate& candidate, const PlaceMemory& memory,
                                       const Matcher& matcher, const LoopVerificationOptions& verification) {
  if (!can_be_searched(scan, memory.local_maps[candidate.local_map])) return std::nullopt;
  const auto start = std::chrono::steady_clock::now();
  const NodeScan& here = memory.nodes[node];
  const PlacedLocalMap& local_map = memory.local_maps[candidate.local_map];
  MatchProblem problem{local_map.map->scores(), scan, candidate.anchor_T_node, candidate.extent};
  problem.min_response = kReportedShare * min_response(candidate.extent, verification);
  problem.measure_ambiguity = true;
  problem.seed = {0, here.frame, local_map.id};
  const MatchResult match = matcher.match(problem);
  if (!match.found) return std::nullopt;

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
  verify(loop, scan, memory, verification);
  loop.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return loop;
}

}  // namespace psi_slam
