// SPDX-License-Identifier: BSD-3-Clause
// State of a run at one moment, for views: plain values that never change once they are published.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exports/unmatched_scans.h"
#include "loop_closure/keyframe_store.h"
#include "psi_slam/frame.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/mapping_session.h"
#include "replay/shared_history.h"
#include "session/edit_journal.h"

namespace psi_slam {

enum class ReplayPhase {
  kOpening,
  kPaused,       ///< waits for Replay::play()
  kPlaying,      ///< maps scans
  kFinalSearch,  ///< the final loop search
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
  std::shared_ptr<const std::vector<TimedEdit>> edits = std::make_shared<std::vector<TimedEdit>>();
};

/// Outcome of an export or of saving a session.
struct WriteOutcome {
  int number = 0;              ///< counts exports, or saved sessions, from 1
  std::filesystem::path path;  ///< the folder of an export, the file of a session
  std::string failure;         ///< a sentence; empty after success
  std::string remark;          ///< what a session file lacks; empty if it is complete
  WrittenWork written{};
};

/// Outcome of an edit.
struct EditOutcome {
  int number = 0;  ///< counts edits from 1
  LoopEdit edit;
  LoopEditOutcome outcome;
};

struct ReplaySnapshot {
  ReplayPhase phase = ReplayPhase::kOpening;
  bool final_search_held = false;  ///< the final loop search is paused
  SessionProgress progress;
  std::string failure;                ///< a sentence, if the phase is kFailed
  std::vector<std::string> warnings;  ///< problems of the log, a sentence each

  HistoryView<Frame> log;  ///< the scans mapped so far
  HistoryView<FrameRecord> frames;
  /// Of `frames`; never null.
  std::shared_ptr<const UnmatchedScans> unmatched = std::make_shared<UnmatchedScans>();
  std::vector<std::size_t> later_run_frames;  ///< the first frame of each run except the first run
  HistoryView<double> shares;                 ///< share of the log read at each scan, in [0, 1]
  HistoryView<NodeScan> nodes;
  /// Finished local maps by number. Only their nodes' points are available: the engine packs and unpacks the
  /// grids, so no other thread may read them.
  HistoryView<LocalMapRecord> local_maps;
  std::vector<ActiveLocalMap> active_local_maps;
  mrpt::math::TPose2D map_T_robot;

  /// Pose of each node after the last optimisation of the graph; never null.
  std::shared_ptr<const std::vector<mrpt::math::TPose2D>> map_T_node =
      std::make_shared<std::vector<mrpt::math::TPose2D>>();
  /// Never null. Another pointer than before means that the loops have changed.
  std::shared_ptr<const std::vector<LoopRecord>> loops = std::make_shared<std::vector<LoopRecord>>();

  /// Edits made so far and planned for later; never null.
  std::shared_ptr<const std::vector<TimedEdit>> edits = std::make_shared<std::vector<TimedEdit>>();
  std::optional<EditOutcome> edited;  ///< outcome of the last edit
  int edits_served = 0;               ///< how many of Replay::edits_asked() have an outcome
  std::string undo_text;              ///< what Replay::undo() would take back; empty if nothing
  std::string redo_text;              ///< what Replay::redo() would make again; empty if nothing

  PsiThresholds psi;
  std::vector<StageTiming> stages;  ///< once finished
  bool interrupted =
      false;  ///< once finished: scans are left unmapped, or the final loop search was cut short
  std::optional<WriteOutcome> exported;  ///< outcome of the last export
  std::optional<WriteOutcome> saved;     ///< outcome of the last saved session
};

/// True if an outcome of a snapshot is not in an earlier snapshot of the same run.
template <class Outcome>
bool is_new(const std::optional<Outcome>& now, const std::optional<Outcome>& before) {
  return now && (!before || now->number != before->number);
}

/// Pose of the robot at a scan in the present map. Once the run is finished it is the result's pose; before,
/// it is the pose of the last node up to the scan, moved by the front end's motion since that node.
mrpt::math::TPose2D map_T_frame(const ReplaySnapshot& snapshot, std::size_t frame);

}  // namespace psi_slam
