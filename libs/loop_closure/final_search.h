// SPDX-License-Identifier: BSD-3-Clause
// The final loop search (method, step 5): after the last scan, matches every node with every local map near
// it in a small window. Small windows suffice, because the map is then nearly correct.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "base/worker_pool.h"
#include "loop_closure/keyframe_store.h"
#include "loop_closure/loop_verification.h"
#include "loop_closure/matcher_policy.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct FinalSearchOptions {
  int passes = 2;  ///< number of passes, each followed by an optimisation; 0: no final loop search
  double window_m = 0.3;
  double window_rad = radians_from_degrees(3.0L);
  double reach_m = 5.0;  ///< largest distance between the node and a node of the local map
  double travel_m = 0;   ///< smallest path between nodes that are matched; 0: matches every node
};

struct FinalSearchOutcome {
  std::vector<LoopRecord> loops;  ///< all matches, accepted or refused, in the order of local map and node
  std::map<MatcherKind, LoopEffort> effort;
};

/// Matches each pair of a node and a nearby local map with `matcher_of(node)`, several pairs in parallel.
/// Skips pairs for which `known(node, local_map)` is true. `run_seed` becomes MatchSeed::run. Calls
/// `progress` in the calling thread with the completed share of the pairs; if it returns false, the search
/// ends.
FinalSearchOutcome final_search(const KeyframeStore& keyframes, const PoseGraph& graph,
                                const std::function<ChosenMatcher(std::size_t node)>& matcher_of,
                                const LoopVerificationOptions& verification,
                                const FinalSearchOptions& options,
                                const std::function<bool(std::size_t node, std::size_t local_map)>& known,
                                std::uint64_t run_seed, WorkerPool& pool,
                                const std::function<bool(double)>& progress);

}  // namespace psi_slam
