// SPDX-License-Identifier: BSD-3-Clause
// The per-loop step: matches a node with every finished local map nearby.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/worker_pool.h"
#include "loop_closure/keyframe_store.h"
#include "loop_closure/loop_candidates.h"
#include "loop_closure/loop_verification.h"
#include "loop_closure/matcher_policy.h"
#include "loop_closure/scan_context.h"
#include "loop_closure/wide_search_schedule.h"
#include "pose_graph/path_covariance.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopClosureOptions {
  LoopCandidateOptions candidates;
  LoopVerificationOptions verification;
  ScanContextOptions context;
  double attempt_distance_m = 0.5;  ///< searches for loops once in this much travel
  std::size_t wide_searches = 1;    ///< most searches of one node in wide windows
};

class LoopCloser {
 public:
  /// `run_seed` goes into MatchSeed.
  LoopCloser(const LoopClosureOptions& options, std::uint64_t run_seed)
      : options_(options), run_seed_(run_seed) {}

  struct Outcome {
    std::vector<LoopRecord> loops;  ///< all attempts in the order of the local maps
    LoopEffort effort;
  };
  /// Matches `node` with all its candidates, several at a time.
  Outcome close(std::size_t node, const KeyframeStore& keyframes, const PoseGraph& graph,
                const ChosenMatcher& matcher, WorkerPool& pool);

  /// Matches `node` with one local map in a given window, and verifies the match. None if the scan has no
  /// points to match.
  std::optional<LoopRecord> match(std::size_t node, const LoopCandidate& candidate,
                                  const KeyframeStore& keyframes, const ChosenMatcher& matcher,
                                  WorkerPool& pool) const;

 private:
  std::vector<LoopCandidate> candidates(std::size_t node, const KeyframeStore& keyframes,
                                        const PoseGraph& graph);

  LoopClosureOptions options_;
  std::uint64_t run_seed_;
  PathCovarianceSearch search_;
  WideSearchSchedule schedule_;
};

}  // namespace psi_slam
