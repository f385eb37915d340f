// SPDX-License-Identifier: BSD-3-Clause
// The back end of SLAM: closes loops, decides when to optimise the pose graph, and finishes the map after the
// last scan. The caller adds the nodes to the graph. Mapper and CPsiLoopCloserERD both use the back end.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "base/worker_pool.h"
#include "mapping/joint_refinement.h"
#include "mapping/loop_closure/final_search.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "mapping/loop_closure/loop_closer.h"
#include "mapping/loop_closure/loop_closure_factor.h"
#include "mapping/loop_closure/loop_consensus.h"
#include "mapping/loop_closure/loop_ledger.h"
#include "mapping/loop_closure/matcher_policy.h"
#include "mapping/optimization_schedule.h"
#include "mapping/stage_clock.h"
#include "pose_graph/incremental_pose_adjustment.h"
#include "pose_graph/known_landmarks.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct BackEndOptions {
  std::optional<MatcherKind> matcher;  ///< empty: the factor Psi chooses the matcher for each node
  MatcherOptions loop_matcher;         ///< options that all matchers share
  GeneticOptions genetic;
  PsiOptions psi;
  LoopClosureOptions loop_closure;
  LoopConsensusOptions loop_consensus;
  FinalSearchOptions final_search;
  JointRefinementOptions joint_refinement;
  /// Standard deviations of extra noise of each loop match, see LoopNoise.
  double loop_sigma_m = 0.02;
  double loop_sigma_rad = radians_from_degrees(0.25L);
  std::uint64_t seed = 1;  ///< seed of all random numbers
  int threads = 1;         ///< number of threads for matching, without effect on the results
  /// Priority of the threads of the back end. If it is low, the front end answers first on a shared
  /// processor.
  ThreadPriority priority = ThreadPriority::kNormal;
};

/// Result of a node's search for loops.
struct NodeLoops {
  MatcherKind matcher = MatcherKind::kCsm;  ///< matcher that Psi selects, also if the node does not search
  bool searched = false;                    ///< whether the node searched for loops
  LoopEffort effort;
  std::map<MatcherKind, LoopEffort> effort_of;  ///< the same effort, divided by matcher
  int accepted = 0;  ///< number of new constraints, including candidates of earlier nodes now confirmed
  double milliseconds = 0;
};

/// Progress of the steps after the last scan, reported as a share of all steps, in [0, 1].
class FinalProgress {
 public:
  /// Creates a progress that calls `report`, which may be empty. If `report` returns false, the remaining
  /// steps are skipped.
  FinalProgress(const BackEndOptions& options, std::function<bool(double)> report)
      : passes_(options.final_search.passes),
        steps_(std::max(1, passes_ + (options.joint_refinement.rounds > 0 ? 1 : 0))),
        report_(std::move(report)) {}

  int passes() const { return passes_; }
  /// Reports the number of completed steps; fractions are allowed. Returns whether to continue.
  bool at(double done) {
    const bool go_on = !report_ || report_(done / steps_);
    cut_short_ = cut_short_ || (!go_on && done < steps_);
    return go_on;
  }
  bool cut_short() const { return cut_short_; }

 private:
  int passes_;
  int steps_;
  std::function<bool(double)> report_;
  bool cut_short_ = false;
};

class BackEnd {
 public:
  explicit BackEnd(const BackEndOptions& options);

  /// Updates the factor Psi with the path length by odometry since the last call, and with the robot's
  /// position in the map. Call for every scan.
  void move(double odometry_m, const mrpt::math::TPoint2D& robot) { factor_.move(odometry_m, robot); }
  LoopClosureFactor::Value factor() const { return factor_.value(); }

  /// Searches for loops of a node, and adds accepted loops to the graph. Also adds candidates of earlier
  /// nodes that are now confirmed. Call it for every node in order.
  NodeLoops close(std::size_t node, const KeyframeStore& keyframes, PoseGraph& graph);

  /// Optimises the graph incrementally if new loops make it necessary, see OptimizationSchedule and
  /// IncrementalPoseAdjustment. Returns the time in milliseconds; nothing without an optimisation.
  std::optional<double> optimize_if_due(PoseGraph& graph, SparsePoseAdjustment& solver);
  /// Solves the whole graph. Returns the time in milliseconds.
  double optimize(PoseGraph& graph, SparsePoseAdjustment& solver);

  /// Makes the searches in wide windows that the last nodes left to later nodes, and runs the final loop
  /// search after the last scan. Before the first pass and after each pass, optimises the
  /// graph and rejects outlier loops. Rejects all remaining candidates. Returns the matcher of the largest
  /// Psi, which searched all windows, and its effort. `known` are the landmarks of the graph; null: none.
  std::pair<MatcherKind, LoopEffort> finish_loops(const KeyframeStore& keyframes, PoseGraph& graph,
                                                  SparsePoseAdjustment& solver, FinalProgress& progress,
                                                  KnownLandmarks* known = nullptr);

  /// Optimises the graph, and rejects outlier loops and landmarks that the scans or each other
  /// contradict. `known` may be null.
  void settle(PoseGraph& graph, SparsePoseAdjustment& solver, KnownLandmarks* known);

  /// Refines the poses of all scans jointly, and sets the graph's nodes to the refined poses. The first node
  /// keeps its pose if it is the root. Does nothing if `progress` was cut short.
  void refine(RefinedScans& scans, PoseGraph& graph, FinalProgress& progress);

  /// Carries out an edit of kind LoopEdit::Kind::kMatch. Returns false if the scan has no returns to match.
  bool match_by_hand(const LoopEdit& edit, std::size_t node, const KeyframeStore& keyframes,
                     PoseGraph& graph);

  const std::vector<LoopRecord>& loops() const { return ledger_.loops(); }
  std::size_t accepted() const;
  LoopLedger& ledger() { return ledger_; }
  const LoopLedger& ledger() const { return ledger_; }
  const BackEndOptions& options() const { return options_; }
  std::vector<StageTiming> stages() const;

 private:
  std::vector<std::size_t> confirmed_by(std::size_t loop, const KeyframeStore& keyframes,
                                        const PoseGraph& graph);
  NodeLoops search(std::size_t node, const KeyframeStore& keyframes, PoseGraph& graph);
  void enter(LoopCloser::Outcome&& outcome, const KeyframeStore& keyframes, PoseGraph& graph,
             NodeLoops& loops);
  LoopEffort search_left_windows(const KeyframeStore& keyframes, PoseGraph& graph,
                                 const NodeMatchers& matchers, FinalProgress& progress);
  LoopEffort run_final_search(const KeyframeStore& keyframes, PoseGraph& graph, const NodeMatchers& matchers,
                              const std::function<bool(double)>& progress);

  BackEndOptions options_;
  MatcherPolicy policy_;
  LoopClosureFactor factor_;
  LoopCloser closer_;
  LoopConsensus consensus_;
  LoopLedger ledger_;
  WorkerPool pool_;
  OptimizationSchedule schedule_;
  IncrementalPoseAdjustment adjustment_;
  StageClock loop_clock_{"close loops"};
  StageClock graph_clock_{"optimise pose graph"};
  StageClock final_search_clock_{"final loop search"};
  StageClock refinement_clock_{"refine all scans jointly"};
};

}  // namespace psi_slam
