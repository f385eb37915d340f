// SPDX-License-Identifier: BSD-3-Clause
#include "replay/log_pace.h"

#include <algorithm>

namespace psi_slam {
namespace {

constexpr std::chrono::seconds kLongest{1};

}  // namespace

void LogPace::set_speed(double speed) {
  speed_ = speed;
  restart();
}

LogPace::Clock::time_point LogPace::due_after(TimeUs time_us, Clock::time_point now) {
  if (speed_ <= 0) return now;
  if (!last_) {
    last_ = Shown{time_us, now};
    return now;
  }
  const double step_s = std::max(0.0, seconds(time_us - last_->time_us) / speed_);
  const auto step = std::chrono::round<std::chrono::microseconds>(
      std::chrono::duration<double>(std::min(step_s, static_cast<double>(kLongest.count()))));
  last_ = Shown{time_us, std::clamp<Clock::time_point>(last_->due + step, now - kLongest, now + kLongest)};
  return last_->due;
}

}  // namespace psi_slam
