// SPDX-License-Identifier: BSD-3-Clause
// Limits of what is decided by the beginning of a log: a stream cannot be looked over as a whole, and a file
// is read as its stream would be.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Length of the beginning of a log that decides unless stated, seconds after the first scan.
inline constexpr double kUsualLookOver_s = 5;

/// Largest number of scans of a stream that wait for odometry.
inline constexpr std::size_t kMostWaitingOfStream = 100;

/// Counts the scans at the beginning of a stream until they are enough to decide what is read: `look_over_s`
/// seconds after the first scan, by the time stamps, or kMostScans. Lasers that the user names are awaited
/// longer: until kLongestWait_s after the first scan, or kMostAwaitedScans.
class LookOver {
 public:
  static constexpr std::size_t kMostScans = 500;
  static constexpr double kLongestWait_s = 30;
  static constexpr std::size_t kMostAwaitedScans = 5000;

  explicit LookOver(double look_over_s) : look_over_s_(look_over_s) {}

  void add_scan(TimeUs time_us) {
    if (scans_++ == 0) first_us_ = time_us;
    passed_s_ = std::abs(seconds(time_us - first_us_));
  }

  /// Returns whether a scan has come.
  bool began() const { return scans_ > 0; }

  /// Returns whether the scans are enough. `awaits_laser`: whether a laser that the user names is missing.
  bool is_enough(bool awaits_laser = false) const {
    if (awaits_laser)
      return passed_s_ >= std::max(look_over_s_, kLongestWait_s) || scans_ >= kMostAwaitedScans;
    return began() && (passed_s_ >= look_over_s_ || scans_ >= kMostScans);
  }

 private:
  double look_over_s_;
  TimeUs first_us_ = 0;
  double passed_s_ = 0;
  std::size_t scans_ = 0;
};

}  // namespace psi_slam
