// SPDX-License-Identifier: BSD-3-Clause
// All of loop closing on a pose graph that somebody else makes grow: which matcher a node gets, its search,
// the consensus of those that wait, the last pass, and which loops the finished graph contradicts. Its ledger
// keeps the record of every attempt and which constraint it became.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "base/worker_pool.h"
#include "loop_closure/final_search.h"
#include "loop_closure/loop_closer.h"
#include "loop_closure/loop_closure_factor.h"
#include "loop_closure/loop_consensus.h"
#include "loop_closure/loop_ledger.h"
#include "loop_closure/matcher_policy.h"
#include "loop_closure/keyframe_store.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct BackEndOptions {
  std::optional<MatcherKind> matcher;  ///< none: the factor Psi chooses a matcher for each node
  MatcherOptions loop_matcher;  ///< what all of them share
  GeneticOptions genetic;
  PsiOptions psi;
  LoopClosureOptions loop_closure;
  LoopConsensusOptions loop_consensus;
  FinalSearchOptions final_search;
  double loop_sigma_m = 0.02;  ///< of a loop, on top of its match's covariance
  double loop_sigma_rad = radians_from_degrees(0.25L);
  double max_loop_chi = 5.0;  ///< a loop that the finished graph contradicts by more standard deviations is
                              ///< switched off
  std::uint64_t seed = 1;     ///< of all random numbers
  int threads = 1;            ///< that match loops; no result depends on it
};

/// What came of a node's search for loops.
struct NodeLoops {
  MatcherKind matcher = MatcherKind::kCsm;  ///< that searched
  LoopEffort effort;
  int accepted = 0;  ///< constraints made, loops of nodes before included
  /// By how many standard deviations of loops the graph contradicted the one it fits least.
  double news = 0;
  bool agreed = false;  ///< loops that had waited are among them: the map has found its place
};

class BackEnd {
 public:
  explicit BackEnd(const BackEndOptions& options);

  /// Odometry's motion since the last call, and where the robot is in the map: Psi depends on both.
  void move(double odometry_m, const mrpt::math::TPoint2D& robot) { factor_.move(odometry_m, robot); }
  LoopClosureFactor::Value factor() const { return factor_.value(); }

  /// The per-loop step of a node, in their order: adds to the graph what is now believed, loops of nodes
  /// before included.
  NodeLoops close(std::size_t node, const KeyframeStore& memory, PoseGraph& graph);

  /// Matches all nodes near a local map once more, and adds what is believed. `progress` is told the share
  /// done; when it returns false, the search ends there. Returns the effort of each matcher.
  std::map<MatcherKind, LoopEffort> run_final_search(const KeyframeStore& memory, PoseGraph& graph,
                                                  const std::function<bool(double)>& progress);

  /// Optimises the graph and switches off the loops that it contradicts.
  void settle(PoseGraph& graph, SparsePoseAdjustment& solver) {
    ledger_.settle(graph, solver, options_.max_loop_chi);
  }

  /// What a person asks for with LoopEdit::Kind::kMatch. False when the scan has no returns to match.
  bool match_by_hand(const LoopEdit& edit, std::size_t node, const KeyframeStore& memory, PoseGraph& graph);

  const std::vector<LoopRecord>& loops() const { return ledger_.loops(); }
  std::size_t accepted() const;
  LoopLedger& ledger() { return ledger_; }
  const LoopLedger& ledger() const { return ledger_; }
  WorkerPool& pool() { return pool_; }

 private:
  std::vector<std::size_t> confirmed_by(std::size_t loop, const KeyframeStore& memory, const PoseGraph& graph);

  BackEndOptions options_;
  MatcherPolicy policy_;
  LoopClosureFactor factor_;
  LoopCloser closer_;
  LoopConsensus consensus_;
  LoopLedger ledger_;
  WorkerPool pool_;
  std::vector<MatcherKind> matcher_of_node_;  ///< that Psi chose there
};

}  // namespace psi_slam
