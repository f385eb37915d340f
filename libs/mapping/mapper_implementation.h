// SPDX-License-Identifier: BSD-3-Clause
// Implementation of Mapper. Its public functions are described in psi_slam/mapper.h.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"

namespace psi_slam {

class Mapper::Implementation {
 public:
  explicit Implementation(const MapperOptions& options);

  const FrameRecord& add(Frame frame);
  void begin_run(const RunStart& start);
  LoopEditOutcome edit(const LoopEdit& edit);
  LoopEditOutcome judge(const LoopEdit& edit, const std::vector<FrameRecord>& frames) const;
  void end_log();
  MappingResult finish(const std::function<bool(double)>& progress, AfterFinish after);
  void reopen(MappingResult&& result);

  mrpt::math::TPose2D map_T_robot() const;
  const PoseGraph& graph() const { return graph_; }
  const MappingResult& result() const { return result_; }
  const std::vector<LoopRecord>& loops() const { return back_end_.loops(); }
  const KeyframeStore& keyframes() const { return keyframes_; }
  const std::vector<PlacedLocalMap>& active_local_maps() const { return front_end_.active(); }

 private:
  /// State that finish() changes and reopen() restores.
  struct Checkpoint {
    PoseGraph graph;
    LoopLedger ledger;
    SparsePoseAdjustment solver;
    std::map<MatcherKind, LoopMatcherRecord> loop_matchers;
    std::vector<Interruption> interruptions;
  };

  void rebase_odometry(FrameRecord& record);
  void straighten_last_scan(const Frame& next, const FrontEndStep& step);
  void thin_standstill(const FrontEndStep& step);
  void record_factor(FrameRecord& record, const FrontEndStep& step);
  void add_node(const FrontEndStep& step, std::size_t frame);
  void join_run();
  void begin_unplaced_run();
  void place_joined_runs(std::size_t first_constraint, std::size_t frame);
  void lay_unjoined_runs_aside();
  void follow_graph();
  void remember(const PlacedLocalMap& finished);
  void close_loops(std::size_t node, FrameRecord& record);
  LoopEditOutcome carry_out(const LoopEdit& edit);
  void serve_waiting_edits();
  std::vector<std::string> unmet_edits() const;
  void finish_loops(FinalProgress& progress);
  void count_accepted_loops();
  void refine_poses(FinalProgress& progress);

  MapperOptions options_;
  FrontEnd front_end_;
  BackEnd back_end_;
  SparsePoseAdjustment solver_;
  PoseGraph graph_;
  KeyframeStore keyframes_;
  std::vector<LoopEdit> waiting_edits_;
  std::vector<std::string> impossible_edits_;  ///< one sentence for each waiting edit that became impossible
  std::optional<Checkpoint> before_finish_;
  /// Whether the start of the next run is only provisional, see unplaced_runs.h.
  bool is_start_provisional_ = false;
  std::optional<RunStart> run_start_;  ///< start of a run that begins with the next frame; otherwise empty
  /// Odometry frame of a later run, in the odometry frame of the first run.
  std::optional<mrpt::math::TPose2D> odom_T_run_;
  mrpt::math::TPose2D map_T_local_;   ///< pose of the front end's frame in the map, from the newest node
  std::optional<Frame> bent_last_;    ///< last frame before the motion during its sweep was removed
  std::deque<std::size_t> repeated_;  ///< scans that lose their ranges if the robot stands a little longer
  MappingResult result_;
  StageClock front_end_clock_{"match and insert scan"};
};

}  // namespace psi_slam
