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
  /// A person made an edit; what was undone before can no longer be redone.
  void note(const LoopEdit& made);

  /// The edit that takes back the newest one; none where there is nothing to undo.
  std::optional<LoopEdit> undo();
  /// The edit that was undone last.
  std::optional<LoopEdit> redo();

  /// What undo() and redo() would take back and do again; empty: nothing.
  std::string undo_text() const { return text_of_last(made_); }
  std::string redo_text() const { return text_of_last(undone_); }

 private:
  static std::string text_of_last(const std::vector<LoopEdit>& edits) {
    return edits.empty() ? "" : text_of(edits.back());
  }

  std::vector<LoopEdit> made_;
  std::vector<LoopEdit> undone_;
};

}  // namespace psi_slam
