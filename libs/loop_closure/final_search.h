// SPDX-License-Identifier: BSD-3-Clause
// The last loop search (method, step 5): when the log has ended and the map has taken its shape, every node
// is matched with every local map near it, in a small window.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "base/worker_pool.h"
#include "psi_slam/loop_record.h"
#include "loop_closure/loop_verification.h"
#include "loop_closure/keyframe_store.h"
#include "loop_closure/matcher_policy.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct FinalSearchOptions {
  int passes = 2;  ///< each followed by an optimisation; 0 leaves the map as the last scan left it
  double window_m = 0.3;
  double window_rad = radians_from_degrees(3.0L);
  double reach_m = 5.0;   ///< a local map is near when one of its nodes is at most this far
  double travel_m = 0;    ///< of all nodes in so much travel one is matched; 0: every node
};

struct FinalSearchOutcome {
  std::vector<LoopRecord> loops;  ///< every match found, accepted or refused, by local map, then node
  std::map<MatcherKind, LoopEffort> effort;
};

/// Matches several pairs at a time, each by `matcher_of(node)`; pairs for which `known(node, local_map)`
/// holds are left out. `run_seed` is that of MatchSeed. `progress` is called with the share done, by the
/// thread that calls; when it returns false, the search ends there.
FinalSearchOutcome final_search(const KeyframeStore& memory, const PoseGraph& graph,
                          const std::function<ChosenMatcher(std::size_t node)>& matcher_of,
                          const LoopVerificationOptions& verification, const FinalSearchOptions& options,
                          const std::function<bool(std::size_t node, std::size_t local_map)>& known,
                          std::uint64_t run_seed, WorkerPool& pool,
                          const std::function<bool(double)>& progress);

}  // namespace psi_slam
