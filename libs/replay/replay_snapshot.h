// SPDX-License-Identifier: BSD-3-Clause
// What a run looks like at one moment, for views: plain values that never change once they are published.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "loop_closure/keyframe_store.h"
#include "psi_slam/mapping_result.h"
#include "replay/shared_history.h"
#include "exports/run_summary.h"
#include "psi_slam/mapping_session.h"

namespace psi_slam {

enum class ReplayPhase {
  kOpening,
  kPaused,    ///< waits to be told to go on
  kPlaying,   ///< maps scans
  kFinalSearch,  ///< the last search for loops
  kFinished,  ///< the map is ready to be exported
  kExporting,
  kFailed,  ///< see ReplaySnapshot::failure; nothing goes on from here
};

/// A local map that scans are inserted into at the moment, as it is.
struct ActiveLocalMap {
  std::size_t id = 0;
  std::size_t anchor = 0;  ///< the node whose pose is its frame
  std::shared_ptr<const mrpt::maps::COccupancyGridMap2D> occupancy;
};

/// What of a run is in files.
struct WrittenWork {
  std::size_t scans = 0;
  std::shared_ptr<const std::vector<TimedEdit>> edits = std::make_shared<std::vector<TimedEdit>>();
};

/// What became of the last export.
struct ExportOutcome {
  int number = 0;  ///< they count from 1
  std::filesystem::path folder;
  std::string failure;  ///< a sentence; empty: all was written
  WrittenWork written{};
};

/// What became of the last session file that was asked for.
struct SaveOutcome {
  int number = 0;  ///< they count from 1
  std::filesystem::path file;
  std::string failure;  ///< a sentence; empty: it was written
  std::string remark;   ///< what the file lacks; empty: nothing
  WrittenWork written{};
};

/// What became of the last edit.
struct EditOutcome {
  int number = 0;  ///< they count from 1
  LoopEdit edit;
  LoopEditOutcome outcome;
};

struct ReplaySnapshot {
  ReplayPhase phase = ReplayPhase::kOpening;
  bool final_search_held = false;  ///< in the last pass: it waits to be told to play, to be cut or to close
  SessionProgress progress;
  std::string failure;                ///< a sentence, where the phase is kFailed
  std::vector<std::string> warnings;  ///< what is wrong with the log, a sentence each

  HistoryView<Frame> log;  ///< the scans mapped so far
  HistoryView<FrameRecord> frames;
  std::vector<std::size_t> later_run_frames;  ///< the first frame of each drive behind the first
  HistoryView<double> shares;             ///< of the log that had been read with each of them, in [0, 1]
  HistoryView<NodeScan> nodes;
  /// Finished ones, by number; of what they hold there are the nodes' points. (The engine packs and unpacks
  /// the maps themselves: nobody else may look at them.)
  HistoryView<LocalMapRecord> local_maps;
  std::vector<ActiveLocalMap> active_local_maps;
  mrpt::math::TPose2D map_T_robot;

  /// Of the graph as it was optimised last; never null.
  std::shared_ptr<const std::vector<mrpt::math::TPose2D>> map_T_node =
      std::make_shared<std::vector<mrpt::math::TPose2D>>();
  /// Never null. Views may tell by the pointer whether anything has changed.
  std::shared_ptr<const std::vector<LoopRecord>> loops = std::make_shared<std::vector<LoopRecord>>();

  /// Those made and those to come, as they were taken up last; never null.
  std::shared_ptr<const std::vector<TimedEdit>> edits = std::make_shared<std::vector<TimedEdit>>();
  std::optional<EditOutcome> edited;  ///< the last that was asked for
  int edits_served = 0;               ///< of Replay::edits_asked()
  std::string undo_text;              ///< what Replay::undo() would take back; empty: nothing
  std::string redo_text;

  PsiThresholds psi;
  std::vector<StageTiming> stages;  ///< once finished
  bool interrupted = false;         ///< once finished: not all of the log was mapped, or its last pass cut
  std::optional<ExportOutcome> exported;  ///< the last export that has ended
  std::optional<SaveOutcome> saved;       ///< the last session file
};

}  // namespace psi_slam
