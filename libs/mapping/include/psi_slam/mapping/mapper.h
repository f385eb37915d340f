// SPDX-License-Identifier: BSD-3-Clause
// The engine: front end, local maps, loop closing and pose graph put together. The headless app, the GUI and
// CMetricMapBuilderPsi all drive this class; it knows nothing of files, windows or options' texts.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "psi_slam/local_maps/front_end.h"
#include "psi_slam/loop_closure/loop_closer.h"
#include "psi_slam/mapping/mapping_result.h"
#include "psi_slam/mapping/stage_clock.h"
#include "psi_slam/pose_graph/pose_graph.h"
#include "psi_slam/pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct MapperOptions {
  FrontEndOptions front_end;
  MatcherOptions loop_matcher;
  LoopClosureOptions loop_closure;
  PoseAdjustmentOptions pose_graph;

  double local_map_sigma_m = 0.02;  ///< of a node's pose in a local map it was inserted into
  double local_map_sigma_rad = 0.004;
  double loop_sigma_m = 0.02;  ///< of a loop, on top of its match's covariance
  double loop_sigma_rad = 0.004;
  bool close_loops = true;
  int last_passes = 2;  ///< global passes after the last scan: all pairs near each other
  double last_pass_window_m = 0.3;
  double last_pass_window_rad = 0.05;
  double last_pass_travel_m = 0.3;  ///< between two nodes that are matched with the same local map
};

class Mapper {
 public:
  explicit Mapper(const MapperOptions& options);

  /// The per-scan step. Frames come in the log's order; returns what became of this one so far.
  const FrameRecord& add(Frame frame);

  /// The last loop search over all pairs near each other and the last optimisation; then the result. The
  /// mapper cannot be used afterwards.
  MappingResult finish();

  /// The robot now, in the global map.
  mrpt::math::TPose2D map_T_robot() const;
  const PoseGraph& graph() const { return graph_; }
  const std::vector<FrameRecord>& frames() const { return result_.frames; }
  const std::vector<LoopRecord>& loops() const { return result_.loops; }

 private:
  void add_node(const FrontEndStep& step, std::size_t frame);
  void remember(const PlacedLocalMap& finished);
  void close_loops(std::size_t node, FrameRecord& record);
  void add_loop_constraint(LoopRecord& loop);
  void optimize(FrameRecord* record);
  void last_pass();
  void switch_off_contradicted_loops();
  void carry_frames_along();

  MapperOptions options_;
  FrontEnd front_end_;
  CorrelativeMatcher loop_matcher_;
  LoopCloser loop_closer_;
  SparsePoseAdjustment solver_;
  PoseGraph graph_;
  PlaceMemory memory_;
  std::vector<std::size_t> loop_constraints_;  ///< for each accepted loop record: its constraint
  std::vector<std::size_t> constraint_loop_;   ///< and the record's index
  mrpt::math::TPose2D map_T_local_;            ///< the front end's frame, as the newest node says
  MappingResult result_;
  StageClock front_end_clock_{"match and insert scan"};
  StageClock loop_clock_{"close loops"};
  StageClock graph_clock_{"optimise pose graph"};
  StageClock last_pass_clock_{"last global pass"};
};

}  // namespace psi_slam
