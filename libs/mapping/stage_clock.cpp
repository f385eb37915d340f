// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/stage_clock.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {

void StageClock::add(double ms) {
  ++timing_.calls;
  timing_.total_s += ms * 1e-3;
  timing_.min_ms = timing_.calls == 1 ? ms : std::min(timing_.min_ms, ms);
  timing_.max_ms = timing_.calls == 1 ? ms : std::max(timing_.max_ms, ms);
  const double before = ms - timing_.mean_ms;
  timing_.mean_ms += before / static_cast<double>(timing_.calls);
  squares_about_mean_ += before * (ms - timing_.mean_ms);
}

StageTiming StageClock::timing() const {
  StageTiming timing = timing_;
  if (timing.calls > 0) timing.std_ms = std::sqrt(squares_about_mean_ / static_cast<double>(timing.calls));
  return timing;
}

}  // namespace psi_slam
