// SPDX-License-Identifier: BSD-3-Clause
#include "replay_slot.h"

#include <algorithm>
#include <utility>

namespace psi_slam {
namespace {

/// Of the last export and the last session file.
ReplaySlot::Written written_of(const Replay& replay) {
  const auto snapshot = replay.snapshot();
  return {snapshot->exported ? snapshot->exported->number : 0, snapshot->saved ? snapshot->saved->number : 0};
}

}  // namespace

void ReplaySlot::open(SessionInput input, const Settings& settings) {
  close();
  replay_ = std::make_unique<Replay>(std::move(input), settings);
}

void ReplaySlot::close() {
  if (!replay_) return;
  const Written before = written_of(*replay_);
  replay_->close();
  closing_.push_back({std::move(replay_), before});
}

std::vector<std::string> ReplaySlot::tidy() {
  std::vector<std::string> failures;
  const auto ended = [&](const Closing& closing) {
    if (!closing.replay->ended()) return false;
    const auto snapshot = closing.replay->snapshot();
    const Written now = written_of(*closing.replay);
    if (now.exports > closing.before.exports) failures.push_back(snapshot->exported->failure);
    if (now.saves > closing.before.saves) failures.push_back(snapshot->saved->failure);
    return true;
  };
  closing_.erase(std::remove_if(closing_.begin(), closing_.end(), ended), closing_.end());
  failures.erase(std::remove(failures.begin(), failures.end(), ""), failures.end());
  return failures;
}

}  // namespace psi_slam
