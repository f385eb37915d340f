// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/session/edit_history.h"

#include <algorithm>

namespace psi_slam {

void EditHistory::note(const LoopEdit& made) {
  made_.push_back(made);
  undone_.clear();
}

std::optional<LoopEdit> EditHistory::undo() {
  if (made_.empty()) return std::nullopt;
  undone_.push_back(made_.back());
  made_.pop_back();
  const LoopEdit& undone = undone_.back();
  const auto before = std::find_if(made_.rbegin(), made_.rend(),
                                   [&](const LoopEdit& edit) { return same_loop(edit, undone); });
  if (before != made_.rend()) return *before;
  return LoopEdit{LoopEdit::Kind::kRestore, undone.frame, undone.local_map};
}

std::optional<LoopEdit> EditHistory::redo() {
  if (undone_.empty()) return std::nullopt;
  made_.push_back(undone_.back());
  undone_.pop_back();
  return made_.back();
}

}  // namespace psi_slam
