// SPDX-License-Identifier: BSD-3-Clause
// Notices a robot that stands still for long. Its scans show the same again and again, so most of their
// ranges may be discarded.
//
// Wheel odometry of a robot that stands still is constant. Scans must agree that the robot stands still: with
// odometry it may be pushed, and without odometry the scans alone tell. The pose of one scan has too much
// noise for this, so the mean pose of the last scans is compared with the mean pose since the robot stopped.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <deque>

#include "psi_slam/frame.h"

namespace psi_slam {

/// A standstill is long after 50 scans and ten seconds. Its decisions about later scans depend only on scans
/// that are kept, so they are the same after the ranges of the others were discarded.
class Standstill {
 public:
  /// Number of scans whose mean pose is compared with the place of the robot.
  static constexpr std::size_t kRecentScans = 20;

  /// Takes a frame that the front end placed at `local_T_robot`, with a match or without.
  void add(const Frame& frame, const mrpt::math::TPose2D& local_T_robot, bool matched);

  /// Returns whether time and odometry say that the robot has stood still for long when it takes this frame.
  bool is_long(const Frame& frame) const;

  /// Takes the pose at which the scan of a robot that has stood still for long fits best. Returns whether the
  /// robot is still at its place. If not, the next call of add() begins another standstill.
  bool confirm(const mrpt::math::TPose2D& local_T_robot);

  /// Takes a frame whose ranges were discarded.
  void skip() { recent_.clear(); }

  /// Mean pose of the robot since it stopped.
  const mrpt::math::TPose2D& place() const { return place_; }

  /// Returns whether a long standstill keeps the scan of this time. The time between kept scans is 0.25 s or
  /// 5 % of the standstill so far, whichever is longer. Their number thus grows with the logarithm of the
  /// time.
  bool keeps(TimeUs time_us);

 private:
  bool agrees_with_odometry(const Frame& frame) const;

  std::size_t scans_ = 0;  ///< number of scans in the mean; 0: the next scan begins a standstill
  TimeUs since_us_ = 0;
  TimeUs last_kept_us_ = 0;
  mrpt::math::TPose2D place_;
  mrpt::math::TPose2D odom_T_robot_;  ///< odometry of the first scan
  bool has_odometry_ = false;
  std::deque<mrpt::math::TPose2D> recent_;  ///< poses of the last scans in succession, at most kRecentScans
};

}  // namespace psi_slam
