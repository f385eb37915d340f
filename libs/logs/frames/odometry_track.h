// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <deque>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Returns whether odometry began again at zero: the pose is zero, and the last pose was not nearby. Returns
/// true also for a step that no robot makes between two scans.
bool was_restarted(const mrpt::math::TPose2D& last, const mrpt::math::TPose2D& now);

/// Poses of odometry by one clock, interpolated between their times. Poses may be added in any order of time,
/// since the scans of several lasers may overtake each other in a log.
class OdometryTrack {
 public:
  /// Largest time by which a pose may be earlier than the last pose. At an earlier pose, the clock was set
  /// back, and another track begins.
  static constexpr TimeUs kMostOvertaking_us = 500'000;

  /// Returns whether another track begins with a pose of this time.
  bool ends_before(TimeUs time_us) const {
    return !poses_.empty() && time_us < poses_.back().time_us - kMostOvertaking_us;
  }

  void add(TimeUs time_us, const mrpt::math::TPose2D& odom_T_robot);

  /// Forgets poses that at() does not need for this time and later.
  void forget_before(TimeUs time_us);

  /// Returns the pose at a time, interpolated between the poses before and after it; the nearer of both in
  /// time if odometry was restarted between them; the first pose before the track, and the last pose after
  /// it. Needs a pose.
  mrpt::math::TPose2D at(TimeUs time_us) const;

  /// Time of the latest pose. Needs a pose.
  TimeUs end_us() const { return poses_.back().time_us; }

 private:
  struct Pose {
    TimeUs time_us;
    mrpt::math::TPose2D odom_T_robot;
  };

  std::deque<Pose> poses_;  // in the order of time
};

}  // namespace psi_slam
