// SPDX-License-Identifier: BSD-3-Clause
// Implementation of Mapper. Its public functions are described in psi_slam/mapper.h.
#pragma once

#include <deque>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapping/back_end_thread.h"
#include "mapping/graph_builder.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"

namespace psi_slam {

class Mapper::Implementation {
 public:
  explicit Implementation(const MapperOptions& options);

  void set_pose_observer(PoseObserver observer) { pose_observer_ = std::move(observer); }
  void set_superseded_observer(ScanObserver observer) { superseded_observer_ = std::move(observer); }
  void run_ahead(std::optional<std::size_t> nodes) { run_ahead_nodes_ = nodes; }
  const FrameRecord& add(Frame frame);
  void begin_run(const RunStart& start);
  LoopEditOutcome edit(const LoopEdit& edit);
  LoopEditOutcome judge(const LoopEdit& edit, const std::vector<FrameRecord>& frames) const;
  void set_knowledge(FixedKnowledge knowledge) { knowledge_ = std::move(knowledge); }
  void end_log();
  MappingResult finish(const std::function<bool(double)>& progress, AfterFinish after);
  void reopen(MappingResult&& result);

  mrpt::math::TPose2D map_T_robot() const;
  const std::vector<mrpt::math::TPose2D>& map_T_node() const { return map_T_node_; }
  std::size_t missed_deadlines() const { return missed_deadlines_; }
  std::optional<Eigen::Matrix3d> newest_covariance() const;
  const MappingResult& result() const { return result_; }
  void wait();
  // The state of the back end; call wait() first.
  const PoseGraph& graph() const { return builder_.graph(); }
  const std::vector<LoopRecord>& loops() const { return builder_.back_end().loops(); }
  const KeyframeStore& keyframes() const { return builder_.keyframes(); }
  const std::vector<PlacedLocalMap>& active_local_maps() const { return front_end_.active(); }

 private:
  /// State that finish() changes and reopen() restores.
  struct Checkpoint {
    GraphBuilder::Checkpoint state;
    std::map<MatcherKind, LoopMatcherRecord> loop_matchers;
    std::vector<Interruption> interruptions;
  };

  /// Correction of the map by the loops of one node. `map_T_node` is empty if it moves only newer nodes.
  struct Correction {
    std::size_t node = 0;
    mrpt::math::TPose2D map_T_local;
    std::vector<mrpt::math::TPose2D> map_T_node;
    std::optional<NodeCovariance> covariance;
  };

  double follow_odometry(FrameRecord& record);
  void straighten_last_scan(const Frame& next, const FrontEndStep& step);
  void thin_standstill(const FrontEndStep& step);
  void add_node(const FrontEndStep& step);
  void draw(FrontEndStep& step);
  std::exception_ptr give_pose();
  void record_local_map(const PlacedLocalMap& finished);
  bool is_superseded(std::size_t node) const { return !keyframes().nodes[node].points; }
  bool runs_ahead() const { return run_ahead_nodes_ && !pose_observer_; }
  std::size_t latency_nodes() const { return runs_ahead() ? *run_ahead_nodes_ : options_.latency_nodes; }
  void take_due_results();
  void take_results(std::size_t end);
  void complete_record(BackEndStep&& done);
  void discard_superseded(const std::vector<std::size_t>& nodes);
  void apply_corrections(std::size_t end_node);
  void catch_up();
  void begin_run();
  void begin_unplaced_run();
  void lay_unjoined_runs_aside();
  LoopEditOutcome carry_out(const LoopEdit& edit);
  bool can_serve_waiting_edits() const;
  void serve_waiting_edits();
  std::vector<std::string> unmet_edits() const;
  std::vector<std::string> contradicted_forces();
  void finish_loops(FinalProgress& progress);
  void finish_graph(bool closes_loops, FinalProgress& progress);
  void count_accepted_loops();
  void refine_poses(FinalProgress& progress);

  MapperOptions options_;
  FrontEnd front_end_;
  GraphBuilder builder_;
  BackEndThread back_end_;
  std::optional<std::size_t> run_ahead_nodes_;  ///< see Mapper::run_ahead()
  std::deque<Correction> corrections_;          ///< corrections by the back end that are not yet due
  bool waited_ = false;                         ///< whether add() has waited for the back end
  std::size_t missed_deadlines_ = 0;            ///< number of calls of add() that waited for the back end
  std::vector<LoopEdit> waiting_edits_;
  std::vector<std::string> impossible_edits_;  ///< one sentence for each waiting edit that became impossible
  FixedKnowledge knowledge_;
  std::optional<Checkpoint> before_finish_;
  /// Odometry pose at which a later run begins, until its first node; otherwise empty.
  std::optional<mrpt::math::TPose2D> odom_T_start_;
  /// Odometry frame of a later run, in the odometry frame of the first run.
  std::optional<mrpt::math::TPose2D> odom_T_run_;
  mrpt::math::TPose2D map_T_local_;              ///< pose of the front end's frame in the map
  std::vector<mrpt::math::TPose2D> map_T_node_;  ///< poses of all nodes, see Mapper::node_poses()
  /// Node of the last correction that was applied, and its covariance.
  std::size_t corrected_node_ = 0;
  std::optional<NodeCovariance> covariance_;
  std::optional<Frame> bent_last_;    ///< last frame before the motion during its sweep was removed
  std::deque<std::size_t> repeated_;  ///< scans that lose their ranges if the robot stands a little longer
  MappingResult result_;
  PoseObserver pose_observer_;
  ScanObserver superseded_observer_;
  StageClock tracking_clock_{"match scan"};
  StageClock drawing_clock_{"draw scan"};
};

}  // namespace psi_slam
