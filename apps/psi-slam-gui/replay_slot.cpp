// SPDX-License-Identifier: BSD-3-Clause
#include "replay_slot.h"

#include <algorithm>
#include <utility>

namespace psi_slam {

void ReplaySlot::open(SessionInput input, const Settings& settings) {
  close();
  replay_ = std::make_unique<Replay>(std::move(input), settings);
}

void ReplaySlot::close() {
  if (!replay_) return;
  replay_->close();
  closing_.push_back(std::move(replay_));
}

void ReplaySlot::tidy() {
  const auto ended = [](const std::unique_ptr<Replay>& replay) { return replay->ended(); };
  closing_.erase(std::remove_if(closing_.begin(), closing_.end(), ended), closing_.end());
}

}  // namespace psi_slam
