// SPDX-License-Identifier: BSD-3-Clause
// Undo and redo of edits. To take one back is an edit, too: the one that was in force for the same loop
// before it, or else to restore the loop; and what was to be done to it later is to be done again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "psi_slam/loop_record.h"
#include "session/edit_journal.h"

namespace psi_slam {

class EditHistory {
 public:
  struct Reversal {
    LoopEdit edit;
    std::vector<TimedEdit> later;  ///< what was to be done to the loop later, and was forgotten
  };

  /// A person made an edit where `before` was in force for the same loop, and `later` was to come. What was
  /// undone before can no longer be redone.
  void note(const LoopEdit& made, const std::optional<LoopEdit>& before, std::vector<TimedEdit> later = {});

  /// What takes back the newest one; none where there is nothing to undo.
  std::optional<Reversal> undo();
  /// The edit that was undone last.
  std::optional<LoopEdit> redo();

  /// What undo() and redo() would take back and do again; empty: nothing.
  std::string undo_text() const { return text_of_last(made_); }
  std::string redo_text() const { return text_of_last(undone_); }

 private:
  struct Step {
    LoopEdit made;
    Reversal back;  // what takes it back
  };
  static std::string text_of_last(const std::vector<Step>& steps) {
    return steps.empty() ? "" : text_of(steps.back().made);
  }

  std::vector<Step> made_;
  std::vector<Step> undone_;
};

}  // namespace psi_slam
