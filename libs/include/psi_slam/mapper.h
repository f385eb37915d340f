// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The mapping engine: turns scans with odometry into a pose graph and a map, scan by scan.
///
///     psi_slam::Mapper mapper;
///     for each scan:  const psi_slam::FrameRecord& record = mapper.add(frame);
///     psi_slam::MappingResult result = mapper.finish();
///
/// Front end, local maps, loop closing and pose graph work together here. The command line, the window and
/// CMetricMapBuilderPsi all drive this class. It reads and writes no files.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct KeyframeStore;
struct MapperOptions;
struct PlacedLocalMap;

/// Where a run begins in a map made before, relative to a node of the graph. No odometry connects the run to
/// the map.
struct RunStart {
  std::size_t node = 0;              ///< node of the map
  mrpt::math::TPose2D node_T_robot;  ///< robot at the start of the run, relative to the node
  /// Pose at which the place was found, relative to the start of the run. There the pose is known best.
  mrpt::math::TPose2D robot_T_found;
};

/// Outcome of an edit.
struct LoopEditOutcome {
  /// What happened to the edit.
  enum class State {
    kDone,        ///< the loop is changed
    kWaits,       ///< until its scan, local map or match exists
    kImpossible,  ///< nothing was changed
  };
  State state = State::kDone;  ///< what happened to the edit
  std::string reason;          ///< why the edit is not done, as a clause
};

/// Maps scans with odometry, one by one, into a pose graph.
class Mapper {
 public:
  /// Maps with the default options.
  Mapper();
  /// Maps with the given options: pass a Configuration.
  explicit Mapper(const MapperOptions& options);
  ~Mapper();
  /// Moves the mapper. The moved-from mapper can only be assigned to or destroyed.
  Mapper(Mapper&& other) noexcept;
  /// Moves the mapper. The moved-from mapper can only be assigned to or destroyed.
  Mapper& operator=(Mapper&& other) noexcept;

  /// The per-scan step. Takes frames in the log's order and returns the record of this frame so far. The
  /// reference is valid until the next call.
  const FrameRecord& add(Frame frame);

  /// Begins another run: the next frame starts at about this place. Loops join the run to the map. The
  /// odometry in its records continues from there, see FrameRecord::odom_T_robot.
  void begin_run(const RunStart& start);

  /// Changes a loop by hand and optimises the graph. An edit waits if its scan, its local map or the match to
  /// force does not exist yet. The next edit of the same scan and local map replaces it.
  LoopEditOutcome edit(const LoopEdit& edit);

  /// What would prevent an edit now. Changes nothing. `frames` are frames() or, after finish(), those of the
  /// result.
  LoopEditOutcome judge(const LoopEdit& edit, const std::vector<FrameRecord>& frames) const;

  /// Finishes the active local maps. Call after the last scan; finish() does so too.
  void end_log();

  /// What remains possible after finish().
  enum class AfterFinish {
    kNothing,  ///< only graph() may be called afterwards
    kReopen,   ///< reopen() is possible; costs the memory of a second graph
  };
  /// Finishes the map: final loop search, optimisation and joint refinement of all scans. `progress` gets the
  /// share done, in [0, 1]. If it returns false, the remaining steps are left out, and the result says that
  /// it was cut short.
  MappingResult finish(const std::function<bool(double)>& progress = {},
                       AfterFinish after = AfterFinish::kNothing);

  /// Restores the state before finish(), so that loops can be edited and the map be finished again. `result`
  /// is what finish() returned; it must have been called with AfterFinish::kReopen.
  void reopen(MappingResult&& result);

  /// Current pose of the robot in the map.
  mrpt::math::TPose2D map_T_robot() const;
  /// Pose graph so far.
  const PoseGraph& graph() const;
  /// All frames so far, in the order in which they were added.
  const std::vector<Frame>& log() const;
  /// Records of all frames so far, in the same order as log().
  const std::vector<FrameRecord>& frames() const;
  /// The first frame of each run after the first run.
  const std::vector<std::size_t>& later_run_frames() const;
  /// Attempts to close loops so far.
  const std::vector<LoopRecord>& loops() const;
  /// Nodes with their scans and local maps; its type is internal.
  const KeyframeStore& keyframes() const;
  /// The local maps that scans are inserted into, older first, at most two; their type is internal.
  const std::vector<PlacedLocalMap>& active_local_maps() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
