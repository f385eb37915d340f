// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "replay/replay.h"

namespace psi_slam {

/// The run that the window shows. Opening another run does not wait for the threads of the previous run.
class ReplaySlot {
 public:
  /// The open run, or null.
  Replay* operator->() const { return replay_.get(); }
  explicit operator bool() const { return replay_ != nullptr; }

  void open(SessionInput input, const Settings& settings);

  /// Deletes closed runs whose threads have ended; call it regularly. Returns why exports and sessions that
  /// were pending when their run was closed were not written, a sentence each.
  std::vector<std::string> tidy();

 private:
  struct Closing {
    std::unique_ptr<Replay> replay;
    std::shared_ptr<const ReplaySnapshot> closed_at;
  };

  std::unique_ptr<Replay> replay_;
  std::vector<Closing> closing_;
};

}  // namespace psi_slam
