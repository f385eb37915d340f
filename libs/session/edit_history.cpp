// SPDX-License-Identifier: BSD-3-Clause
#include "session/edit_history.h"

#include <utility>

namespace psi_slam {

void EditHistory::note(const LoopEdit& made, const std::optional<LoopEdit>& before,
                       std::vector<TimedEdit> later) {
  const LoopEdit restore{LoopEdit::Kind::kRestore, made.frame, made.local_map};
  made_.push_back({made, {before.value_or(restore), std::move(later)}});
  undone_.clear();
}

std::optional<EditHistory::Reversal> EditHistory::undo() {
  if (made_.empty()) return std::nullopt;
  undone_.push_back(made_.back());
  made_.pop_back();
  return undone_.back().back;
}

std::optional<LoopEdit> EditHistory::redo() {
  if (undone_.empty()) return std::nullopt;
  made_.push_back(undone_.back());
  undone_.pop_back();
  return made_.back().made;
}

}  // namespace psi_slam
