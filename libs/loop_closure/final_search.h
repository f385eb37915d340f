// SPDX-License-Identifier: BSD-3-Clause
// The final loop search (method, step 5): after the last scan, matches every node with every local map near
// it in a small window. The map has taken its shape by then.
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
  int passes = 2;  ///< each followed by an optimisation; 0 for no final search
  double window_m = 0.3;
  double window_rad = radians_from_degrees(3.0L);
  double reach_m = 5.0;  ///< largest distance between the node and a node of the local map
  double travel_m = 0;   ///< matches one node in this much travel; 0: every node
};

struct FinalSearchOutcome {
  std::vector<LoopRecord> loops;  ///< all matches, accepted or refused, by local map, then node
  std::map<MatcherKind, LoopEffort> effort;
};

/// Matches each pair with `matcher_of(node)`, several at a time. Leaves out pairs for which
/// `known(node, local_map)` holds. `run_seed` goes into MatchSeed. `progress` gets the share done, in the
/// calling thread; if it returns false, the search ends.
FinalSearchOutcome final_search(const KeyframeStore& keyframes, const PoseGraph& graph,
                                const std::function<ChosenMatcher(std::size_t node)>& matcher_of,
                                const LoopVerificationOptions& verification,
                                const FinalSearchOptions& options,
                                const std::function<bool(std::size_t node, std::size_t local_map)>& known,
                                std::uint64_t run_seed, WorkerPool& pool,
                                const std::function<bool(double)>& progress);

}  // namespace psi_slam
