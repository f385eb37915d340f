// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/odometry_track.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "logs/frames/pose_operations.h"

namespace psi_slam {

using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

bool was_restarted(const TPose2D& last, const TPose2D& now) {
  constexpr double kZero_m = 0.05;
  constexpr double kZero_rad = 0.05;
  constexpr double kLeastJump_m = 1.0;
  constexpr double kFarthestStep_m = 1000.0;
  if (distance_m(last, now) > kFarthestStep_m) return true;
  return now.norm() < kZero_m && std::abs(wrapToPi(now.phi)) < kZero_rad && last.norm() > kLeastJump_m;
}

void OdometryTrack::add(TimeUs time_us, const TPose2D& odom_T_robot) {
  auto place = poses_.end();
  while (place != poses_.begin() && std::prev(place)->time_us > time_us) --place;
  poses_.insert(place, {time_us, odom_T_robot});
}

void OdometryTrack::forget_before(TimeUs time_us) {
  while (poses_.size() > 1 && poses_[1].time_us < time_us) poses_.pop_front();
}

TPose2D OdometryTrack::at(TimeUs time_us) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), time_us,
                                      [](const Pose& pose, TimeUs time) { return pose.time_us < time; });
  if (after == poses_.end()) return poses_.back().odom_T_robot;
  if (after == poses_.begin()) return after->odom_T_robot;
  const auto before = std::prev(after);
  const double fraction =
      static_cast<double>(time_us - before->time_us) / static_cast<double>(after->time_us - before->time_us);
  if (was_restarted(before->odom_T_robot, after->odom_T_robot))
    return fraction < 0.5 ? before->odom_T_robot : after->odom_T_robot;
  return interpolate(before->odom_T_robot, after->odom_T_robot, fraction);
}

}  // namespace psi_slam
