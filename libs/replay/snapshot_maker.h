// SPDX-License-Identifier: BSD-3-Clause
// Follows a session in the engine's thread and makes snapshots of it, copying only what is new.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "replay/map_painter.h"
#include "replay/replay_snapshot.h"
#include "session/edit_history.h"

namespace psi_slam {

class SnapshotMaker {
 public:
  /// `edits` are those that the run begins with.
  SnapshotMaker(const PsiThresholds& psi, const std::vector<TimedEdit>& edits);

  /// A scan was mapped, with this much of the log read.
  void note_scan(double share) { shares_.push_back(share); }
  void note_progress(const SessionProgress& progress) { now_.progress = progress; }
  void note_warnings(std::vector<std::string> sentences) { now_.warnings = std::move(sentences); }
  /// What was edited until now was written, or not; an export holds all scans, too.
  void note_save(SaveOutcome outcome);
  void note_export(ExportOutcome outcome);
  void note_held(bool held) { now_.final_search_held = held; }
  /// Loops, poses and edits are others now.
  void note_edits(const std::vector<TimedEdit>& edits, const EditHistory& history);
  void note_edited(EditOutcome outcome) { now_.edited = std::move(outcome); }
  /// So many of those asked for were made or found impossible.
  void note_served(int edits) { now_.edits_served += edits; }
  void note_failure(std::string sentence) { now_.failure = std::move(sentence); }

  /// Takes over what is new, before the session is finished; active local maps, which cost most, at each call
  /// or now and then.
  enum class ActiveMaps { kAtOnce, kNowAndThen };
  void follow(const Mapper& mapper, ActiveMaps active);
  /// The last local maps end when the last pass begins.
  void follow_local_maps(const Mapper& mapper);
  /// Takes over the result, once it is.
  void take(const MappingResult& result);

  std::shared_ptr<const ReplaySnapshot> snapshot(ReplayPhase phase);

  /// The map as it is known: of the nodes' scans, after take() of all scans.
  MapSketch sketch() const;

 private:
  void copy_active(const Mapper& mapper, ActiveMaps active);

  ReplaySnapshot now_;
  SharedHistory<Frame> log_;
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
