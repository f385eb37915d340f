// SPDX-License-Identifier: BSD-3-Clause
// What would be lost if the window closed now: scans that were mapped, and loops edited by hand, since
// results, a session or a file of edits were written last.
#pragma once

#include <string>

#include "replay/replay_snapshot.h"
#include "session/edit_journal.h"
#include "session/session_input.h"

namespace psi_slam {

/// Those of a snapshot or of what was written.
EditJournal journal_of(const std::vector<TimedEdit>& edits);

class UnsavedWork {
 public:
  /// It is mapped from its start, with the edits of a file, its own or another.
  void open(const SessionInput& input);
  /// The same with all edits made so far, written or not.
  void begin_again(const SessionInput& input);

  void note_written(const WrittenWork& written);
  void note_written_edits(const EditJournal& edits);

  bool any_edits(const ReplaySnapshot& snapshot) const;
  bool any(const ReplaySnapshot& snapshot) const;

 private:
  std::size_t written_scans_ = 0;
  std::string written_edits_ = EditJournal().text();
};

}  // namespace psi_slam
