// SPDX-License-Identifier: BSD-3-Clause
// Undo and redo of edits. To take one back is an edit, too: the one that was in force for the same loop
// before it, or else to restore the loop.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "psi_slam/loop_closure/loop_edit.h"

namespace psi_slam {

class EditHistory {
 public:
  /// A person made an edit where `before` was in force for the same loop. What was undone before can no
  /// longer be redone.
  void note(const LoopEdit& made, const std::optional<LoopEdit>& before);

  /// The edit that takes back the newest one; none where there is nothing to undo.
  std::optional<LoopEdit> undo();
  /// The edit that was undone last.
  std::optional<LoopEdit> redo();

  /// What undo() and redo() would take back and do again; empty: nothing.
  std::string undo_text() const { return text_of_last(made_); }
  std::string redo_text() const { return text_of_last(undone_); }

 private:
  struct Step {
    LoopEdit made;
    LoopEdit back;  // what takes it back
  };
  static std::string text_of_last(const std::vector<Step>& steps) {
    return steps.empty() ? "" : text_of(steps.back().made);
  }

  std::vector<Step> made_;
  std::vector<Step> undone_;
};

}  // namespace psi_slam
