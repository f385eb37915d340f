// SPDX-License-Identifier: BSD-3-Clause
// Searches for the loops of one node: matches it with the finished local maps nearby.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "base/worker_pool.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "mapping/loop_closure/loop_candidates.h"
#include "mapping/loop_closure/loop_verification.h"
#include "mapping/loop_closure/matcher_policy.h"
#include "mapping/loop_closure/scan_context.h"
#include "mapping/loop_closure/wide_search_schedule.h"
#include "pose_graph/path_covariance.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct LoopClosureOptions {
  LoopCandidateOptions candidates;
  LoopVerificationOptions verification;
  ScanContextOptions context;
  double attempt_distance_m = 0.5;  ///< the first node of each stretch of this length searches for loops
  std::size_t wide_searches = 1;    ///< largest number of searches in wide windows per node
};

class LoopCloser {
 public:
  /// Creates a loop closer. `run_seed` becomes MatchSeed::run.
  LoopCloser(const LoopClosureOptions& options, std::uint64_t run_seed)
      : options_(options), run_seed_(run_seed) {}

  struct Outcome {
    /// Whether the node searched for loops: only the first node of each stretch does. True also if the search
    /// had no candidates.
    bool searched = false;
    std::vector<LoopRecord> loops;  ///< all attempts, in the order of the local maps
    LoopEffort effort;
    std::map<MatcherKind, LoopEffort> effort_of;  ///< the same effort, divided by matcher
  };
  /// Matches `node` with all its candidates, several in parallel.
  Outcome close(std::size_t node, const KeyframeStore& keyframes, const PoseGraph& graph,
                const NodeMatchers& matchers, WorkerPool& pool);

  /// Matches `node` with candidates in wide windows that close() left to later nodes: at most eight of those
  /// with local maps for which `is_known` is false. For the last nodes of a log, which no nodes follow.
  Outcome close_wide(std::size_t node, const KeyframeStore& keyframes, const PoseGraph& graph,
                     const NodeMatchers& matchers, WorkerPool& pool,
                     const std::function<bool(std::size_t local_map)>& is_known);

  /// Matches `node` with one local map in a given window, and verifies the match. Returns nothing if the scan
  /// has no points to match.
  std::optional<LoopRecord> match(std::size_t node, const LoopCandidate& candidate,
                                  const KeyframeStore& keyframes, const NodeMatchers& matchers,
                                  WorkerPool& pool) const;

 private:
  struct Candidates {
    std::vector<LoopCandidate> narrow;
    std::vector<LoopCandidate> wide;
  };
  Candidates candidates(std::size_t node, const KeyframeStore& keyframes, const PoseGraph& graph);
  void match_all(std::size_t node, const std::vector<LoopCandidate>& candidates,
                 const KeyframeStore& keyframes, const NodeMatchers& matchers, WorkerPool& pool,
                 Outcome& outcome) const;
  std::vector<LoopCandidate> unplaced_candidates(std::size_t node, const KeyframeStore& keyframes,
                                                 const PoseGraph& graph);

  LoopClosureOptions options_;
  std::uint64_t run_seed_;
  PathCovarianceSearch search_;
  WideSearchSchedule schedule_;
  std::size_t unplaced_run_ = 0;       ///< first node of the last run whose place was unknown
  std::size_t unplaced_searches_ = 0;  ///< number of searches at the beginning of that run
};

}  // namespace psi_slam
