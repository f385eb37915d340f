// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "gui/map_painter.h"
#include "gui/replay_snapshot.h"
#include "session/edit_history.h"

namespace psi_slam {

/// Makes snapshots of a session in the mapping thread. Copies only what has changed since the last snapshot.
class SnapshotMaker {
 public:
  /// `edits` are the edits that are planned before the run starts. `live`: see ReplaySnapshot::live.
  SnapshotMaker(const PsiThresholds& psi, const EditJournal& edits, bool live);

  /// The next snapshot. The caller may set all members except the histories and the members that
  /// note_export(), note_save(), note_edits(), note_changed_loops(), follow() and take() set.
  ReplaySnapshot now;

  /// Notes that a scan was mapped. `share` is the share of the log read so far, in [0, 1].
  void note_scan(double share) { shares_.push_back(share); }
  /// Notes the outcome of an export, which contains all scans.
  void note_export(WriteOutcome outcome);
  /// Notes the outcome of saving a session.
  void note_save(WriteOutcome outcome);
  /// Notes that edits were made or undone.
  void note_edits(const EditJournal& edits, const EditHistory& history);
  /// Notes that edits have changed loops and poses.
  void note_changed_loops();

  /// When follow() copies the active local maps, which is expensive: at each call, or at most every 400 ms.
  enum class ActiveMaps { kAtOnce, kNowAndThen };
  /// Copies what the mapper has added since the last call. Call it only before the session is finished.
  void follow(const Mapper& mapper, ActiveMaps active);
  /// Copies only the finished local maps. The last local maps are finished when the final loop search begins.
  void follow_local_maps(const Mapper& mapper);
  /// Copies the result of the finished session.
  void take(const MappingResult& result);

  /// Returns a copy of `now` with the given phase and with views of all scans, nodes and local maps so far.
  std::shared_ptr<const ReplaySnapshot> snapshot(ReplayPhase phase);

  /// Returns the scans and poses for drawing the current map: of the nodes, or of all scans after take().
  MapSketch sketch() const;

 private:
  void follow_log(const std::vector<Frame>& log);
  void copy_active(const Mapper& mapper, ActiveMaps active);

  SharedHistory<Frame> log_;
  std::size_t settled_blocks_ = 0;  ///< number of blocks of log_ whose frames the mapper no longer changes
  SharedHistory<FrameRecord> frames_;
  SharedHistory<double> shares_;
  SharedHistory<NodeScan> nodes_;
  SharedHistory<LocalMapRecord> local_maps_;
  std::size_t frames_copied_active_ = 0;
  std::chrono::steady_clock::time_point copied_active_at_;
  bool loops_changed_ = false;
  bool finished_ = false;
};

}  // namespace psi_slam
