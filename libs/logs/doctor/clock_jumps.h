// SPDX-License-Identifier: BSD-3-Clause
// Finds where the clock of a log was set during the recording.
#pragma once

#include <cstddef>
#include <vector>

#include "logs/doctor/log_facts.h"

namespace psi_slam {

/// A jump of the clock between a frame and the frame before it.
struct ClockJump {
  std::size_t frame = 0;
  double jump_s = 0;  ///< time since the frame before; negative: the clock was set back
};

/// Returns the steps back in time of more than a second. If `has_odometry`, returns also the gaps of more
/// than five seconds and 20 periods during which a moving robot moved at most twice as far as in the
/// shorter of the periods before and after: during a true gap it moves on. Odometry that begins again
/// elsewhere is no jump of the clock, nor is a pause in a log that is thinned by distance.
std::vector<ClockJump> clock_jumps(const std::vector<FrameMark>& marks, double median_period_s,
                                   bool has_odometry);

}  // namespace psi_slam
