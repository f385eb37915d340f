// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gui/replay.h"

namespace psi_slam {

/// The run that the window shows. Opening another run does not wait for the threads of the previous run.
class ReplaySlot {
 public:
  /// The open run, or null.
  Replay* operator->() const { return replay_.get(); }
  explicit operator bool() const { return replay_ != nullptr; }

  /// Opens a run of a SessionInput or a LiveStream.
  template <class Input>
  void open(Input input, const Settings& settings) {
    if (replay_) {
      const auto closed_at = replay_->snapshot();
      replay_->close();
      closing_.push_back({std::move(replay_), closed_at});
    }
    replay_ = std::make_unique<Replay>(std::move(input), settings);
  }

  /// Deletes closed runs whose threads have ended; call it regularly. Returns an error message for each
  /// export or session that was pending when its run was closed and could not be written.
  std::vector<std::string> tidy() {
    std::vector<std::string> failures;
    const auto ended = [&](const Closing& closing) {
      if (!closing.replay->ended()) return false;
      const auto now = closing.replay->snapshot();
      for (const auto outcome : {&ReplaySnapshot::exported, &ReplaySnapshot::saved})
        if (is_new((*now).*outcome, (*closing.closed_at).*outcome) && !((*now).*outcome)->failure.empty())
          failures.push_back(((*now).*outcome)->failure);
      return true;
    };
    closing_.erase(std::remove_if(closing_.begin(), closing_.end(), ended), closing_.end());
    return failures;
  }

 private:
  struct Closing {
    std::unique_ptr<Replay> replay;
    std::shared_ptr<const ReplaySnapshot> closed_at;
  };

  std::unique_ptr<Replay> replay_;
  std::vector<Closing> closing_;
};

}  // namespace psi_slam
