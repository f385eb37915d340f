// SPDX-License-Identifier: BSD-3-Clause
// Builds the pose graph from the steps of the front end: adds nodes and their constraints, closes loops and
// optimises. The results depend only on the sequence of calls, so a thread of its own may make them, see
// BackEndThread.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "mapping/back_end.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "mapping/loop_closure/loop_closure_factor.h"
#include "mapping/mapper_options.h"
#include "pose_graph/newest_covariance.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/mapper.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// What the front end hands over to the back end for one frame.
struct TrackedFrame {
  std::size_t frame = 0;  ///< number of the frame
  double odometry_m = 0;  ///< path length by odometry since the frame before
  FrontEndStep step;
};

/// Covariance of a node relative to the root, in the axes of the map: m^2, m rad, rad^2.
struct NodeCovariance {
  mrpt::math::TPose2D map_T_node;
  Eigen::Matrix3d covariance;
  Eigen::Matrix3d drift;  ///< part of `covariance` that came with the way from the node before
};

/// Result of the back end for one frame.
struct BackEndStep {
  std::size_t frame = 0;
  LoopClosureFactor::Value factor;  ///< factor Psi before the loops of this frame
  std::optional<std::size_t> node;
  NodeLoops loops;  ///< search for loops of the node
  double pose_graph_ms = 0;
  mrpt::math::TPose2D map_T_local;  ///< pose of the front end's frame in the map, with the loops of the frame
  /// Poses of all nodes if the frame moved earlier nodes; otherwise empty.
  std::vector<mrpt::math::TPose2D> map_T_node;
  /// Covariance of the node, with the loops of the frame, if MapperOptions::estimates_covariance.
  std::optional<NodeCovariance> covariance;
  std::vector<std::size_t> joined;  ///< interruptions whose runs the loops of this frame joined to the map
  std::vector<std::size_t> superseded;  ///< nodes whose scans later passes supersede, see superseded_maps.h
};

class GraphBuilder {
 public:
  explicit GraphBuilder(const MapperOptions& options);

  /// Adds one frame. Call it for all frames in their order.
  BackEndStep add(const TrackedFrame& tracked);

  /// Adds a finished local map whose nodes are all in the graph.
  void remember(const PlacedLocalMap& finished) { remember_local_map(finished, keyframes_); }

  /// Begins another run at `start`. An unplaced run begins at a provisional place: it has the number of its
  /// interruption, and its start is ignored.
  void begin_run(const RunStart& start);
  void begin_unplaced_run(std::size_t interruption);

  struct Edited {
    LoopEditOutcome outcome;
    std::vector<std::size_t> joined;  ///< interruptions whose runs the edit joined to the map
  };
  /// Carries out an edit of a loop whose node and local map exist, and optimises the graph.
  Edited carry_out(const LoopEdit& edit, std::size_t node);

  /// Adds landmarks to the graph. No frames may be added before restore().
  void add_landmarks(const std::vector<Landmark>& landmarks) { known_.emplace(landmarks, graph_); }
  /// The landmarks of the graph; empty without add_landmarks().
  const std::optional<KnownLandmarks>& landmarks() const { return known_; }
  /// Moves all nodes into the frame that the landmarks state, if there are any.
  void move_to_site();

  /// Runs the final loop search, see BackEnd::finish_loops().
  std::pair<MatcherKind, LoopEffort> finish_loops(FinalProgress& progress) {
    return back_end_.finish_loops(keyframes_, graph_, solver_, progress, known_ ? &*known_ : nullptr);
  }
  /// Optimises the graph with the landmarks, without searching loops.
  void settle_landmarks();
  std::vector<LoopLedger::ContradictedForce> contradicted_forces() {
    return back_end_.ledger().contradicted_forces(graph_, solver_);
  }
  void refine(RefinedScans& scans, FinalProgress& progress) { back_end_.refine(scans, graph_, progress); }

  /// Moves those of `runs` beside the map that no loop joins to it, and returns them.
  std::vector<UnplacedRun> lay_unjoined_aside(const std::vector<UnplacedRun>& runs);

  /// State that the final steps change. Landmarks are not part of it.
  struct Checkpoint {
    PoseGraph graph;
    LoopLedger ledger;
    SparsePoseAdjustment solver;
  };
  Checkpoint checkpoint() const { return {graph_, back_end_.ledger(), solver_}; }
  void restore(Checkpoint&& before);

  const PoseGraph& graph() const { return graph_; }
  const KeyframeStore& keyframes() const { return keyframes_; }
  const BackEnd& back_end() const { return back_end_; }
  std::vector<LoopRecord> take_loops() { return back_end_.ledger().take_loops(); }
  /// Pose of the front end's frame in the map, from the newest node. Before the first node of a later run,
  /// from the start of that run.
  const mrpt::math::TPose2D& map_T_local() const { return map_T_local_; }

 private:
  void add_node(const TrackedFrame& tracked);
  void join_run();
  void close_loops(std::size_t node, BackEndStep& done);
  std::vector<std::size_t> place_joined_runs(std::size_t first_constraint);
  std::vector<std::size_t> drop_superseded();
  void follow_graph();
  std::optional<NodeCovariance> newest_covariance();

  MapperOptions options_;
  BackEnd back_end_;
  SparsePoseAdjustment solver_;
  PoseGraph graph_;
  KeyframeStore keyframes_;
  /// Whether the start of the next run is only provisional, see unplaced_runs.h.
  bool is_start_provisional_ = false;
  std::optional<KnownLandmarks> known_;
  std::optional<RunStart> run_start_;  ///< start of a run that begins with the next node; otherwise empty
  mrpt::math::TPose2D map_T_local_;
  NewestCovariance newest_covariance_;
};

}  // namespace psi_slam
