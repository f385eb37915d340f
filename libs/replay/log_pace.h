// SPDX-License-Identifier: BSD-3-Clause
// When the next scan of a log is due that is replayed as fast as it was recorded, or so many times faster.
#pragma once

#include <chrono>
#include <optional>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

class LogPace {
 public:
  using Clock = std::chrono::steady_clock;

  /// Times the recording's own speed; 0: as fast as possible.
  void set_speed(double speed);
  double speed() const { return speed_; }

  /// Time begins anew at the next scan: after a pause, or another speed.
  void restart() { last_.reset(); }

  /// A scan with this stamp was shown at `now`: when the one after it may be. A gap in the log, forwards or
  /// backwards, is waited for one second at most, and where the mapper cannot keep up, it is not hurried
  /// afterwards to make up for more than that.
  Clock::time_point due_after(TimeUs time_us, Clock::time_point now);

 private:
  struct Shown {
    TimeUs time_us;
    Clock::time_point due;
  };
  double speed_ = 1;
  std::optional<Shown> last_;
};

}  // namespace psi_slam
