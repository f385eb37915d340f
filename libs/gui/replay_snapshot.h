// SPDX-License-Identifier: BSD-3-Clause
// State of a run at one moment, for views. Published snapshots never change.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gui/shared_history.h"
#include "map/exports/unmatched_scans.h"
#include "map/verdict/map_verdict.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "psi_slam/frame.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/mapping_session.h"
#include "session/edit_journal.h"

namespace psi_slam {

enum class ReplayPhase {
  kOpening,
  kPaused,       ///< waits for Replay::play()
  kPlaying,      ///< maps scans
  kFinalSearch,  ///< runs the final loop search
  kFinished,     ///< the map is ready for export
  kExporting,
  kFailed,  ///< see ReplaySnapshot::failure; the run has ended
};

/// Copy of a local map that scans are still inserted into.
struct ActiveLocalMap {
  std::size_t id = 0;
  std::size_t anchor = 0;  ///< the node whose pose is the local map's frame
  std::shared_ptr<const mrpt::maps::COccupancyGridMap2D> occupancy;
};

/// The part of a run that has been written to files.
struct WrittenWork {
  std::size_t scans = 0;
  std::shared_ptr<const EditJournal> edits = std::make_shared<EditJournal>();
};

/// Outcome of exporting results or saving a session.
struct WriteOutcome {
  int number = 0;              ///< number of the export or of the saved session, from 1
  std::filesystem::path path;  ///< the folder of an export, the file of a session
  std::string failure;         ///< why writing failed, as a sentence; empty after success
  std::string remark;          ///< sentence about missing parts of a session file; empty if complete
  WrittenWork written{};
};

/// Outcome of an edit.
struct EditOutcome {
  int number = 0;  ///< number of the edit, from 1
  AnyEdit edit;
  LoopEditOutcome outcome;
  bool undone = false;  ///< an edit of the drawn map that was removed again
};

struct ReplaySnapshot {
  ReplayPhase phase = ReplayPhase::kOpening;
  bool live = false;               ///< the scans come from a live source, not from a log
  bool final_search_held = false;  ///< the final loop search is paused
  SessionProgress progress;
  std::string failure;  ///< why the run failed, as a sentence; empty unless the phase is kFailed
  std::vector<std::string> warnings;  ///< problems of the log, a sentence each

  HistoryView<Frame> log;  ///< the scans mapped so far
  HistoryView<FrameRecord> frames;
  /// Stretches of unmatched scans among `frames`; never null.
  std::shared_ptr<const UnmatchedScans> unmatched = std::make_shared<UnmatchedScans>();
  std::vector<std::size_t> later_run_frames;  ///< first frame of each run except the first run
  HistoryView<double> shares;                 ///< share of the log read at each scan, in [0, 1]
  HistoryView<NodeScan> nodes;
  /// Node numbers of each finished local map, indexed by the number of the map. Contains no grids, because
  /// the mapping thread may compress them at any time.
  HistoryView<LocalMapRecord> local_maps;
  std::vector<ActiveLocalMap> active_local_maps;
  mrpt::math::TPose2D map_T_robot;

  /// Pose of each node after the last optimisation of the graph; never null.
  std::shared_ptr<const std::vector<mrpt::math::TPose2D>> map_T_node =
      std::make_shared<std::vector<mrpt::math::TPose2D>>();
  /// Covariance of each node's pose, see placed_covariances(); never null, no elements unless the run is
  /// finished.
  std::shared_ptr<const std::vector<std::optional<Eigen::Matrix3d>>> node_covariances =
      std::make_shared<std::vector<std::optional<Eigen::Matrix3d>>>();
  /// Verdict about the map; null unless the run is finished.
  std::shared_ptr<const MapVerdict> verdict;
  /// All loops; never null. A new pointer means that the loops may have changed.
  std::shared_ptr<const std::vector<LoopRecord>> loops = std::make_shared<std::vector<LoopRecord>>();

  /// Edits made so far and edits planned for later scans; never null.
  std::shared_ptr<const EditJournal> edits = std::make_shared<EditJournal>();
  std::optional<EditOutcome> edited;  ///< outcome of the last edit
  int edits_served = 0;               ///< number of calls in Replay::edits_asked() that have an outcome
  std::string undo_text;  ///< text of the edit that Replay::undo() would undo; empty if there is none
  std::string redo_text;  ///< text of the edit that Replay::redo() would repeat; empty if there is none

  PsiThresholds psi;
  std::vector<StageTiming> stages;  ///< times of the stages; empty until the run is finished
  /// True if the finished run left scans unmapped or cut the final loop search short.
  bool interrupted = false;
  std::optional<WriteOutcome> exported;  ///< outcome of the last export
  std::optional<WriteOutcome> saved;     ///< outcome of the last saved session
};

/// True if a snapshot has an outcome that an earlier snapshot of the same run does not have.
template <class Outcome>
bool is_new(const std::optional<Outcome>& now, const std::optional<Outcome>& before) {
  return now && (!before || now->number != before->number);
}

/// Pose of the robot at a scan, in the current map. Once the run is finished, it is the pose of the result.
/// Before, it is the pose of the last node up to the scan, moved by the front end's motion since that node.
mrpt::math::TPose2D map_T_frame(const ReplaySnapshot& snapshot, std::size_t frame);

}  // namespace psi_slam
