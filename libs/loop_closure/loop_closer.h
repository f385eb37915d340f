// SPDX-License-Identifier: BSD-3-Clause
// The per-loop step: a node against every nearby finished local map.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/worker_pool.h"
#include "loop_closure/loop_candidates.h"
#include "psi_slam/loop_record.h"
#include "loop_closure/loop_verification.h"
#include "loop_closure/keyframe_store.h"
#include "loop_closure/scan_context.h"
#include "loop_closure/matcher_policy.h"
#include "pose_graph/path_covariance.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopClosureOptions {
  LoopCandidateOptions candidates;
  LoopVerificationOptions verification;
  ScanContextOptions context;
  double attempt_distance_m = 0.5;  ///< loops are looked for once in so much travel
};

class LoopCloser {
 public:
  /// `run_seed` is that of MatchSeed.
  LoopCloser(const LoopClosureOptions& options, std::uint64_t run_seed)
      : options_(options), run_seed_(run_seed) {}

  struct Outcome {
    std::vector<LoopRecord>
        loops;  ///< every attempt, accepted, refused or without a match, in the order of the local maps
    LoopEffort effort;
  };
  /// Matches `node` with every local map it may see again, several at a time.
  Outcome close(std::size_t node, const KeyframeStore& memory, const PoseGraph& graph, const ChosenMatcher& matcher,
                WorkerPool& pool);

  /// Matches `node` with one local map in a window that somebody else chose, verified like the others. None
  /// when the scan is blind.
  std::optional<LoopRecord> match(std::size_t node, const LoopCandidate& candidate, const KeyframeStore& memory,
                                  const ChosenMatcher& matcher, WorkerPool& pool) const;

 private:
  LoopClosureOptions options_;
  std::uint64_t run_seed_;
  PathCovarianceSearch search_;
};

}  // namespace psi_slam
