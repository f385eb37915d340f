// SPDX-License-Identifier: BSD-3-Clause
#include "unsaved_work.h"

namespace psi_slam {

EditJournal journal_of(const std::vector<TimedEdit>& edits) {
  EditJournal journal;
  for (const TimedEdit& edit : edits) journal.add(edit);
  return journal;
}

void UnsavedWork::open(const SessionInput& input) {
  begin_again(input);
  written_edits_ = input.edits().text();
}

void UnsavedWork::begin_again(const SessionInput& input) {
  written_scans_ = input.recording() ? input.recording()->frames.size() : 0;
}

void UnsavedWork::note_written(const WrittenWork& written) {
  written_scans_ = written.scans;
  written_edits_ = journal_of(*written.edits).text();
}

void UnsavedWork::note_written_edits(const EditJournal& edits) {
  written_edits_ = edits.text();
}

bool UnsavedWork::any_edits(const ReplaySnapshot& snapshot) const {
  return journal_of(*snapshot.edits).text() != written_edits_;
}

bool UnsavedWork::any(const ReplaySnapshot& snapshot) const {
  return snapshot.frames.size() > written_scans_ || any_edits(snapshot);
}

}  // namespace psi_slam
