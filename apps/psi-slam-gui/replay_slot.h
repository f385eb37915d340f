// SPDX-License-Identifier: BSD-3-Clause
// The run that the window shows. Another one takes its place at once, however busy the one before still is.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "replay/replay.h"

namespace psi_slam {

class ReplaySlot {
 public:
  /// Null as long as no log is open.
  Replay* operator->() const { return replay_.get(); }
  explicit operator bool() const { return replay_ != nullptr; }

  void open(SessionInput input, const Settings& settings);
  void close();

  /// Lets go of closed runs whose threads have ended; to be called now and then. Returns why exports and
  /// sessions were not written that had been asked for when their runs were closed, a sentence each.
  std::vector<std::string> tidy();

  /// How many were, or failed.
  struct Written {
    int exports = 0;
    int saves = 0;
  };

 private:
  struct Closing {
    std::unique_ptr<Replay> replay;
    Written before;
  };

  std::unique_ptr<Replay> replay_;
  std::vector<Closing> closing_;
};

}  // namespace psi_slam
