// SPDX-License-Identifier: BSD-3-Clause
#include "replay_slot.h"

#include <algorithm>
#include <utility>

namespace psi_slam {
namespace {

int exports_of(const Replay& replay) {
  const auto snapshot = replay.snapshot();
  return snapshot->exported ? snapshot->exported->number : 0;
}

}  // namespace

void ReplaySlot::open(SessionInput input, const Settings& settings) {
  close();
  replay_ = std::make_unique<Replay>(std::move(input), settings);
}

void ReplaySlot::close() {
  if (!replay_) return;
  const int exports = exports_of(*replay_);
  replay_->close();
  closing_.push_back({std::move(replay_), exports});
}

std::vector<std::string> ReplaySlot::tidy() {
  std::vector<std::string> failures;
  const auto ended = [&](const Closing& closing) {
    if (!closing.replay->ended()) return false;
    if (exports_of(*closing.replay) > closing.exports_before)
      if (const std::string& failure = closing.replay->snapshot()->exported->failure; !failure.empty())
        failures.push_back(failure);
    return true;
  };
  closing_.erase(std::remove_if(closing_.begin(), closing_.end(), ended), closing_.end());
  return failures;
}

}  // namespace psi_slam
