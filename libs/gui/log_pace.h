// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Times at which the scans of a log are due when the log is replayed at a multiple of its recorded speed.
class LogPace {
 public:
  using Clock = std::chrono::steady_clock;

  /// Sets the speed as a multiple of the recorded speed; 0 is as fast as possible. Also calls restart().
  void set_speed(double speed) {
    speed_ = speed;
    restart();
  }

  /// Makes the next scan start a new schedule. Call it after a pause.
  void restart() { last_.reset(); }

  /// Returns when the next scan is due after a scan with time stamp `time_us` was shown at `now`. A gap in
  /// the log causes a wait of at most one second; time stamps that run backwards cause no wait. If mapping is
  /// too slow, the following scans make up at most one second of the delay.
  Clock::time_point due_after(TimeUs time_us, Clock::time_point now) {
    if (speed_ <= 0) return now;
    if (last_) {
      const double step_s = std::clamp(seconds(time_us - last_->time_us) / speed_, 0.0, 1.0);
      const auto step = std::chrono::round<std::chrono::microseconds>(std::chrono::duration<double>(step_s));
      constexpr std::chrono::seconds kLongest{1};
      now = std::clamp<Clock::time_point>(last_->due + step, now - kLongest, now + kLongest);
    }
    last_ = Shown{time_us, now};
    return now;
  }

 private:
  struct Shown {
    TimeUs time_us;
    Clock::time_point due;
  };
  double speed_ = 1;
  std::optional<Shown> last_;
};

}  // namespace psi_slam
