// SPDX-License-Identifier: BSD-3-Clause
#include "replay_slot.h"

#include <algorithm>
#include <utility>

namespace psi_slam {

void ReplaySlot::open(SessionInput input, const Settings& settings) {
  if (replay_) {
    const auto closed_at = replay_->snapshot();
    replay_->close();
    closing_.push_back({std::move(replay_), closed_at});
  }
  replay_ = std::make_unique<Replay>(std::move(input), settings);
}

std::vector<std::string> ReplaySlot::tidy() {
  std::vector<std::string> failures;
  const auto note = [&](const std::optional<WriteOutcome>& before, const std::optional<WriteOutcome>& now) {
    const bool is_new = now && (!before || now->number > before->number);
    if (is_new && !now->failure.empty()) failures.push_back(now->failure);
  };
  const auto ended = [&](const Closing& closing) {
    if (!closing.replay->ended()) return false;
    const auto now = closing.replay->snapshot();
    note(closing.closed_at->exported, now->exported);
    note(closing.closed_at->saved, now->saved);
    return true;
  };
  closing_.erase(std::remove_if(closing_.begin(), closing_.end(), ended), closing_.end());
  return failures;
}

}  // namespace psi_slam
