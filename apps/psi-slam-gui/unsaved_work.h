// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "replay/replay_snapshot.h"
#include "session/edit_journal.h"
#include "session/session_input.h"

namespace psi_slam {

inline EditJournal journal_of(const std::vector<TimedEdit>& edits) {
  EditJournal journal;
  for (const TimedEdit& edit : edits) journal.add(edit);
  return journal;
}

/// Tracks what closing the window would lose: scans mapped and edits made since results, a session or a file
/// of edits were last written. Edits of the drawn map cannot change in the window, so they do not count.
class UnsavedWork {
 public:
  /// Call this when a run is opened whose edits come from a file.
  void open(const SessionInput& input) {
    restart(input);
    written_edits_ = journal_of(input.edits().edits()).text();
  }
  /// Call this when the run is restarted or resumed with a log. Unsaved edits still count as unsaved.
  void restart(const SessionInput& input) {
    written_scans_ = input.recording() ? input.recording()->frames.size() : 0;
  }

  void note_written(const WrittenWork& written) {
    written_scans_ = written.scans;
    written_edits_ = journal_of(*written.edits).text();
  }
  void note_written_edits(const EditJournal& edits) { written_edits_ = journal_of(edits.edits()).text(); }

  bool any_edits(const ReplaySnapshot& snapshot) const {
    return journal_of(*snapshot.edits).text() != written_edits_;
  }
  bool any(const ReplaySnapshot& snapshot) const {
    return snapshot.frames.size() > written_scans_ || any_edits(snapshot);
  }

 private:
  std::size_t written_scans_ = 0;
  std::string written_edits_ = EditJournal().text();
};

}  // namespace psi_slam
