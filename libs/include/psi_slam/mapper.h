// SPDX-License-Identifier: BSD-3-Clause
// The engine: front end, local maps, loop closing and pose graph put together. The headless app, the GUI and
// CMetricMapBuilderPsi all drive this class; it knows nothing of files, windows or options' texts.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "local_maps/front_end.h"
#include "psi_slam/loop_record.h"
#include "loop_closure/back_end.h"
#include "mapping/run_start.h"
#include "mapping/joint_refinement.h"
#include "psi_slam/mapping_result.h"
#include "mapping/stage_clock.h"
#include "psi_slam/pose_graph.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct MapperOptions : BackEndOptions {
  FrontEndOptions front_end;
  JointRefinementOptions joint_refinement;
  PoseAdjustmentOptions pose_graph;

  bool close_loops = true;
  double local_map_sigma_m =
      0.015;  ///< of a node's pose in a local map, on top of the front end's covariance
  double local_map_sigma_rad = radians_from_degrees(0.25L);
};

/// What became of an edit.
struct LoopEditOutcome {
  enum class State {
    kDone,
    kWaits,       ///< for what is still to come
    kImpossible,  ///< and nothing was changed
  };
  State state = State::kDone;
  std::string reason;  ///< why it is not done, as a clause
};

class Mapper {
 public:
  explicit Mapper(const MapperOptions& options);

  /// The per-scan step. Frames come in the log's order; returns what became of this one so far.
  const FrameRecord& add(Frame frame);

  /// The next scan is the first of another drive, which begins about there: no odometry joins it to the scans
  /// before, loops are to. Odometry is told on from there (FrameRecord::odom_T_robot).
  void begin_run(const RunStart& start);

  /// Changes a loop by hand, and optimises the graph. An edit whose scan or local map is still to come, or a
  /// match that is to be forced and has not been found yet, waits for it; the next edit of the same two
  /// replaces it.
  LoopEditOutcome edit(const LoopEdit& edit);

  /// What stands against an edit, without making it. `frames` are those of the mapper, or, after finish(), of
  /// its result.
  LoopEditOutcome judge(const LoopEdit& edit, const std::vector<FrameRecord>& frames) const;

  /// No scan comes any more: the last local maps are finished.
  void end_log();

  enum class AfterFinish {
    kNothing,  ///< the mapper can be asked for its graph, but not go on
    kReopen,   ///< costs the memory of a second graph
  };
  /// The last loop search over all pairs near each other and the last optimisation; then, where loops are
  /// closed and nothing is cut short, the refinement of all scans; then the result. `progress` is called with
  /// the share done, in [0, 1]; when it returns false, the search ends there: the map is of the loops found
  /// until then, and the result says that it was cut short.
  MappingResult finish(const std::function<bool(double)>& progress = {},
                       AfterFinish after = AfterFinish::kNothing);

  /// Takes back what finish() made, to be edited and finished again: all is as it was after end_log().
  void reopen(MappingResult&& result);

  /// The robot now, in the global map.
  mrpt::math::TPose2D map_T_robot() const;
  const PoseGraph& graph() const { return graph_; }
  const std::vector<Frame>& log() const { return result_.log; }
  const std::vector<FrameRecord>& frames() const { return result_.frames; }
  const std::vector<std::size_t>& later_run_frames() const { return result_.later_run_frames; }
  const std::vector<LoopRecord>& loops() const { return back_end_.loops(); }
  const KeyframeStore& memory() const { return memory_; }
  const std::vector<PlacedLocalMap>& active_local_maps() const { return front_end_.active(); }

 private:
  void record_factor(FrameRecord& record, const FrontEndStep& step);
  /// What finish() changes and reopen() brings back.
  struct Checkpoint {
    PoseGraph graph;
    LoopLedger ledger;
    SparsePoseAdjustment solver;
    std::map<MatcherKind, LoopMatcherRecord> loop_matchers;
  };

  void rebase_odometry(FrameRecord& record);
  void add_node(const FrontEndStep& step, std::size_t frame);
  void join_run();
  void follow_graph();
  void remember(const PlacedLocalMap& finished);
  void close_loops(std::size_t node, FrameRecord& record);
  bool is_time_to_optimize() const;
  void optimize();
  LoopEditOutcome carry_out(const LoopEdit& edit);
  void serve_waiting_edits();
  std::vector<std::string> unmet_edits() const;
  void run_final_search(const std::function<bool(double)>& progress);
  void settle_loops();
  void count_accepted_loops();
  void refine_poses(const std::function<bool(double)>& progress);

  MapperOptions options_;
  FrontEnd front_end_;
  BackEnd back_end_;
  SparsePoseAdjustment solver_;
  PoseGraph graph_;
  KeyframeStore memory_;
  std::vector<LoopEdit> waiting_edits_;
  std::vector<std::string> impossible_edits_;  ///< of those that had waited, a sentence each
  std::optional<Checkpoint> before_finish_;
  std::optional<RunStart> run_start_;            ///< of the scan that comes next
  std::optional<mrpt::math::TPose2D> odom_T_run_;  ///< of a later drive: its odometry in the first one's
  mrpt::math::TPose2D map_T_local_;  ///< the front end's frame, as the newest node says
  double worst_residual_ = 0;                  ///< of NodeLoops, the most since the graph was optimised
  std::size_t optimized_nodes_ = 0;  ///< in the graph then
  MappingResult result_;
  StageClock front_end_clock_{"match and insert scan"};
  StageClock loop_clock_{"close loops"};
  StageClock graph_clock_{"optimise pose graph"};
  StageClock final_search_clock_{"last global pass"};
  StageClock refinement_clock_{"refine all scans jointly"};
};

}  // namespace psi_slam
