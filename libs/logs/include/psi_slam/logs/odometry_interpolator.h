// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <deque>
#include <optional>

#include "psi_slam/logs/frame.h"

namespace psi_slam {

/// The pose between two poses, `fraction` in [0, 1] of the way, turning the shorter way round.
mrpt::math::TPose2D interpolate(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to,
                                double fraction);

/// Gives scans the odometry of their own time where a log has odometry and scans as separate messages. A scan
/// waits until odometry at least as late has come, and is interpolated between it and the message before;
/// scans before the first odometry or after the last get that one's pose. Scans leave in the order in which
/// they came.
class OdometryInterpolator {
 public:
  /// Scans that wait for odometry beyond this number get the last pose there is: odometry has stopped.
  static constexpr std::size_t kMaxWaiting = 1000;

  void add_odometry(TimeUs time_us, const mrpt::math::TPose2D& odom_T_robot);
  void add_scan(Frame frame);
  void end_of_log() { ended_ = true; }

  /// The next scan whose odometry is known.
  std::optional<Frame> take();

  bool has_odometry() const { return !odometry_.empty(); }
  std::size_t waiting() const { return scans_.size(); }

 private:
  struct Odometry {
    TimeUs time_us;
    mrpt::math::TPose2D odom_T_robot;
  };

  bool place_between_messages(Frame& frame) const;

  std::deque<Odometry> odometry_;
  std::deque<Frame> scans_;
  bool ended_ = false;
};

}  // namespace psi_slam
