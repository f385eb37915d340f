// SPDX-License-Identifier: BSD-3-Clause
// The final loop search: after the last scan, matches nodes with all nearby local maps in small windows.
// Small windows suffice, because the map is then nearly correct.
//
// Where many local maps overlap, most matches would only confirm others, because successive nodes see the
// same walls. There, each local map is matched with only one node per path segment. Different local maps use
// different nodes of a segment, so most nodes are matched with some local map.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "base/worker_pool.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "mapping/loop_closure/loop_verification.h"
#include "mapping/loop_closure/matcher_policy.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Nodes with at most this many local maps near them are matched with all of these.
inline constexpr int kFewMaps = 4;

struct FinalSearchOptions {
  int passes = 2;  ///< number of passes, each followed by an optimisation; 0: no final loop search
  double window_m = 0.3;
  double window_rad = radians_from_degrees(3.0L);
  double reach_m = 5.0;  ///< largest distance between a node and the nearest node of a local map
  /// Where more than kFewMaps local maps are near, each is matched with one node in every stretch of this
  /// travel, see travel_and_turn_m(); 0: with all nodes.
  double travel_m = 0.9;
};

struct FinalSearchOutcome {
  std::vector<LoopRecord> loops;  ///< all matches, accepted or rejected, by local map and then by node
  LoopEffort effort;
};

/// Matches pairs of a node and a nearby local map with `matchers`, several pairs in parallel.
/// Skips nodes of the local map itself, and pairs for which `known(node, local_map)` is true. `run_seed`
/// becomes MatchSeed::run. Calls `progress` in the calling thread with the completed share of the pairs, in
/// [0, 1]. If `progress` returns false, the search ends.
FinalSearchOutcome final_search(const KeyframeStore& keyframes, const PoseGraph& graph,
                                const NodeMatchers& matchers, const LoopVerificationOptions& verification,
                                const FinalSearchOptions& options,
                                const std::function<bool(std::size_t node, std::size_t local_map)>& known,
                                std::uint64_t run_seed, WorkerPool& pool,
                                const std::function<bool(double)>& progress);

}  // namespace psi_slam
