// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "gui/replay_snapshot.h"
#include "session/edit_journal.h"
#include "session/session_input.h"

namespace psi_slam {

/// Tracks what closing the window would lose: scans mapped and edits made since results, a session or a file
/// of edits were last written.
class UnsavedWork {
 public:
  /// Call this when a run is opened whose edits come from a file.
  void open(const SessionInput& input) {
    restart(input);
    written_edits_ = input.edits().text();
  }
  /// Call this when the run is restarted or resumed with a log. Unsaved edits still count as unsaved.
  void restart(const SessionInput& input) {
    written_scans_ = input.recording() ? input.recording()->frames.size() : 0;
  }

  void note_written(const WrittenWork& written) {
    written_scans_ = written.scans;
    note_written_edits(*written.edits);
  }
  void note_written_edits(const EditJournal& edits) { written_edits_ = edits.text(); }

  bool any_edits(const ReplaySnapshot& snapshot) const { return snapshot.edits->text() != written_edits_; }
  bool any(const ReplaySnapshot& snapshot) const {
    return snapshot.frames.size() > written_scans_ || any_edits(snapshot);
  }

 private:
  std::size_t written_scans_ = 0;
  std::string written_edits_ = EditJournal().text();
};

}  // namespace psi_slam
