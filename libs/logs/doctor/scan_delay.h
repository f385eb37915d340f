// SPDX-License-Identifier: BSD-3-Clause
// Estimates the delay between the time stamps of scans and those of odometry: compares the turns by scans
// with the turns by odometry at shifted times, by least squares over many pairs of scans.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/significance.h"
#include "logs/doctor/log_facts.h"
#include "logs/doctor/scan_sampling.h"

namespace psi_slam {

/// Turn of the robot between two frames according to their scans.
struct ScanTurn {
  FramePair frames;
  double turn_rad = 0;
};

/// Delays by drivers and networks are shorter. Clocks that were not synchronised differ by more.
inline constexpr double kMostEstimatedDelay_s = 1;

struct ScanDelay {
  std::size_t turns = 0;   ///< number of pairs of scans that were compared
  double delay_s = 0;      ///< see LogOptions::scan_delay_s
  double deviation_s = 0;  ///< standard deviation

  /// Returns whether the delay differs from 0 by at least four standard deviations.
  bool is_significant() const { return std::abs(delay_s) > kSignificantDeviations * deviation_s; }
};

/// Estimates the delay, at most kMostEstimatedDelay_s. Also estimates the ratio of turns by odometry to turns
/// by scans, so that a wrong wheel base does not affect the delay. A constant turn rate does not show the
/// delay; the standard deviation is then up to a second. Empty in three cases: fewer than 40 turns; no delay
/// below one second explains the turns; or odometry mostly has fewer than two poses per second, so that
/// interpolation errors look like a delay.
std::optional<ScanDelay> estimate_scan_delay(const std::vector<FrameMark>& marks,
                                             const std::vector<ScanTurn>& turns);

/// Finds clocks that differ by more than a second: searches delays of up to five minutes, but at most half of
/// the log, for one that explains the turns far better than smaller delays, and than odometry that does not
/// turn or is in degrees. Empty without such a delay, and for fewer than 40 turns.
std::optional<ScanDelay> estimate_clock_offset(const std::vector<FrameMark>& marks,
                                               const std::vector<ScanTurn>& turns);

/// Returns the marks with the odometry of the times at which the scans were measured.
std::vector<FrameMark> with_scan_delay(const std::vector<FrameMark>& marks, double delay_s);

}  // namespace psi_slam
