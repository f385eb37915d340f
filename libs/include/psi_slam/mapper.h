// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The mapping engine: turns scans, with or without odometry, into a pose graph and a map, scan by scan.
///
///     psi_slam::Mapper mapper;
///     for each scan:  const psi_slam::FrameRecord& record = mapper.add(frame);
///     psi_slam::MappingResult result = mapper.finish();
///
/// Mapper combines the front end, local maps, loop closing and the pose graph. psi-slam, psi-slam-gui and
/// CMetricMapBuilderPsi use it. Mapper reads and writes no files.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/frame.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct KeyframeStore;
struct MapperOptions;
struct PlacedLocalMap;

/// Start of another run in an existing map, relative to a node of the graph. No odometry connects the run to
/// the map.
struct RunStart {
  std::size_t node = 0;              ///< node of the existing map, near the start of the run
  mrpt::math::TPose2D node_T_robot;  ///< pose of the robot at the start of the run, in the frame of the node
  /// Pose at which the localizer found the robot in the map, in the frame of the start pose of the robot. Of
  /// all poses of the run, this one is known best.
  mrpt::math::TPose2D robot_T_found;
};

/// Outcome of an edit of a loop.
struct LoopEditOutcome {
  /// State of an edit.
  enum class State {
    kDone,        ///< the loop is changed
    kWaits,       ///< the edit waits until its scan, local map or match exists
    kImpossible,  ///< the edit cannot be made; nothing was changed
  };
  State state = State::kDone;  ///< state of the edit
  std::string reason;          ///< why the edit is not done, as a clause; empty if done
};

/// Maps scans, with or without odometry, one by one into a pose graph.
///
/// Call all functions, const ones too, from one thread at a time. References that they return are valid until
/// the next call of a non-const function. Then the back end may change these objects.
class Mapper {
 public:
  /// Creates a mapper with the default options.
  Mapper();
  /// Creates a mapper with the given options. A Configuration converts to MapperOptions, whose definition is
  /// internal.
  explicit Mapper(const MapperOptions& options);
  ~Mapper();
  /// Moves the mapper. The moved-from mapper can only be assigned to or destroyed.
  Mapper(Mapper&& other) noexcept;
  /// Moves the mapper. The moved-from mapper can only be assigned to or destroyed.
  Mapper& operator=(Mapper&& other) noexcept;

  /// Gets the record of a frame that is being added, as soon as its pose is known.
  using PoseObserver = std::function<void(const FrameRecord&)>;
  /// Sets an observer that add() calls before it draws the scan into local maps. Drawing takes a part of the
  /// time of add(), and often less is left until the next scan. With latency_nodes = 0, the observer is
  /// called after the loops of the frame are closed. The observer may only call frames(),
  /// active_local_maps(), newest_covariance() and missed_deadlines(). If it throws, add() passes the
  /// exception on after it has mapped the frame.
  void set_pose_observer(PoseObserver observer);

  /// Gets the number of a scan and the scan.
  using ScanObserver = std::function<void(std::size_t frame, const Frame& scan)>;
  /// Sets an observer that gets each scan before the mapper discards its ranges because later passes
  /// supersede it. add(), wait() and the functions that call wait() call the observer, which may call no
  /// function of the mapper and must not throw.
  void set_superseded_observer(ScanObserver observer);

  /// Lets add() run up to `nodes` nodes ahead of the back end, and corrects the map as soon as results
  /// arrive. So the poses of records before finish() depend on the speed of the threads; the finished map
  /// does not. An empty value restores MapperOptions::latency_nodes. Poses no longer depend on the speed
  /// after latency_nodes further nodes, or after end_log(). While there is a pose observer, run_ahead() has
  /// no effect.
  void run_ahead(std::optional<std::size_t> nodes);

  /// Maps one frame and returns its record. Call it for all frames in the order of the log. finish()
  /// completes the record.
  ///
  /// Loops of a node correct the map exactly MapperOptions::latency_nodes nodes later. If they are not found
  /// by then, add() waits for them. Psi and the loops in the record of that node may be complete before.
  /// Unless add() may run_ahead(), the returned pose depends only on the frames and the options.
  const FrameRecord& add(Frame frame);

  /// Begins another run, whose first frame is near `start`. At least one frame must have been added. Loops
  /// with earlier runs join the run to the map. In the records of the run, odometry continues from `start`,
  /// see FrameRecord::odom_T_robot.
  void begin_run(const RunStart& start);

  /// Changes a loop by hand and optimises the graph. An edit waits if its scan, its local map or the match to
  /// force does not exist yet. A later edit of the same scan and local map replaces the waiting edit.
  LoopEditOutcome edit(const LoopEdit& edit);

  /// Returns whether the scan and the local map of an edit exist and can form a loop, and if not, why. Does
  /// not check whether a match to force or an edit to undo exists. Changes nothing. Pass frames() as `frames`
  /// or, after finish(), the frames of the result.
  LoopEditOutcome judge(const LoopEdit& edit, const std::vector<FrameRecord>& frames) const;

  /// Sets what is known from outside. It replaces what was set before, and finish() uses it. The poses while
  /// mapping do not depend on it.
  void set_knowledge(FixedKnowledge knowledge);

  /// Finishes the active local maps and makes the edits that wait for them. Call after the last scan, unless
  /// finish() follows at once.
  void end_log();

  /// Functions that remain available after finish().
  enum class AfterFinish {
    kNothing,  ///< only graph() may be called afterwards
    kReopen,   ///< reopen() and judge() may be called too; needs the memory of a second graph
  };
  /// Finishes the map: final loop search, optimisation and joint refinement of all scans. What is known from
  /// outside enters the optimisation. If it states a frame, the map is moved there. `progress` gets the
  /// completed share of the work, in [0, 1]. If it returns false, the remaining steps are skipped, and
  /// MappingResult::final_search_cut_short is true. It must not throw.
  MappingResult finish(const std::function<bool(double)>& progress = {},
                       AfterFinish after = AfterFinish::kNothing);

  /// Restores the graph and the loops before finish(), but not the poses of frames(). Then loops can be
  /// edited, and the map can be finished again. Needs a call of finish() with AfterFinish::kReopen; pass its
  /// return value as `result`.
  void reopen(MappingResult&& result);

  /// Pose of the robot in the map at the last frame; the zero pose before the first frame.
  mrpt::math::TPose2D map_T_robot() const;
  /// Poses of all nodes in the map, as corrected by the results that have arrived. Does not wait for the back
  /// end, unlike graph().
  const std::vector<mrpt::math::TPose2D>& node_poses() const;
  /// Covariance of (x, y, yaw) of the pose of the last frame relative to the first pose, in the axes of the
  /// map: m^2, m rad, rad^2. Accounts for the loops whose results have arrived. Empty without
  /// MapperOptions::estimates_covariance, and if the constraints do not determine the pose. Empty also until
  /// the first result after the start, an edit or a new run.
  std::optional<Eigen::Matrix3d> newest_covariance() const;
  /// Number of calls of add() that waited for a result of the back end before the pose was known.
  std::size_t missed_deadlines() const;
  /// Waits until the back end has processed all frames, and completes their records. graph(), loops(),
  /// keyframes(), judge(), edit(), begin_run() and end_log() call this first.
  void wait() const;
  /// Pose graph so far.
  const PoseGraph& graph() const;
  /// All frames so far, in the order in which they were added. Scans that repeat others at a standstill, and
  /// those that later passes of the robot supersede, lack their ranges.
  const std::vector<Frame>& log() const;
  /// Records of all frames so far, in the same order as log().
  const std::vector<FrameRecord>& frames() const;
  /// Number of the first frame of each run after the first run.
  const std::vector<std::size_t>& later_run_frames() const;
  /// Attempts to close loops so far.
  const std::vector<LoopRecord>& loops() const;
  /// Keyframe store: the nodes with their scans, and the finished local maps. Its type is internal.
  const KeyframeStore& keyframes() const;
  /// Local maps into which scans are inserted, older first; at most two. Their type is internal.
  const std::vector<PlacedLocalMap>& active_local_maps() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
