// SPDX-License-Identifier: BSD-3-Clause
// Undo and redo of edits, of loops and of the drawn map in one history. Undoing an edit of a loop is an edit,
// too: it repeats the previous edit of the same loop, or restores the loop if there was no previous edit. It
// also plans the later edits of the loop again. Undoing an edit of the drawn map removes it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "psi_slam/loop_record.h"
#include "session/edit_journal.h"

namespace psi_slam {

class EditHistory {
 public:
  /// How to undo an edit of a loop.
  struct Reversal {
    LoopEdit edit;
    std::vector<TimedEdit> later;  ///< planned edits of the same loop that the undone edit removed
  };
  /// How to undo an edit: by an edit of the loop, or by removing this last edit of the drawn map.
  using Undo = std::variant<Reversal, MapEdit>;

  /// Notes an edit that the user made. `before` is the previous edit of the same loop; `later` are the
  /// planned edits of that loop, which the new edit removes. Nothing can be redone afterwards.
  void note(const LoopEdit& made, const std::optional<LoopEdit>& before, std::vector<TimedEdit> later = {}) {
    const LoopEdit restore{LoopEdit::Kind::kRestore, made.frame, made.local_map};
    add({made, Reversal{before.value_or(restore), std::move(later)}});
  }
  /// Notes an edit of the drawn map that the user made. Nothing can be redone afterwards.
  void note(const MapEdit& made) { add({made, made}); }

  /// Returns how to undo the newest edit; empty if there is nothing to undo.
  std::optional<Undo> undo() {
    if (!move_last(made_, undone_)) return std::nullopt;
    return undone_.back().back;
  }
  /// Returns the edit that was undone last, to make it again; empty if there is nothing to redo.
  std::optional<AnyEdit> redo() {
    if (!move_last(undone_, made_)) return std::nullopt;
    return made_.back().made;
  }

  /// The edits that undo() would undo and redo() would repeat; null if there is none.
  const AnyEdit* next_undo() const { return last_of(made_); }
  const AnyEdit* next_redo() const { return last_of(undone_); }
  /// Texts of these edits; empty if there is none.
  std::string undo_text() const { return text_of_last(made_); }
  std::string redo_text() const { return text_of_last(undone_); }

 private:
  struct Step {
    AnyEdit made;
    Undo back;  ///< undoes `made`
  };
  void add(Step step) {
    made_.push_back(std::move(step));
    undone_.clear();
  }
  static bool move_last(std::vector<Step>& from, std::vector<Step>& to) {
    if (from.empty()) return false;
    to.push_back(std::move(from.back()));
    from.pop_back();
    return true;
  }
  static const AnyEdit* last_of(const std::vector<Step>& steps) {
    return steps.empty() ? nullptr : &steps.back().made;
  }
  static std::string text_of_last(const std::vector<Step>& steps) {
    return steps.empty() ? "" : text_of(steps.back().made);
  }

  std::vector<Step> made_;
  std::vector<Step> undone_;
};

}  // namespace psi_slam
