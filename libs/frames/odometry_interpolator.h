// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <deque>
#include <optional>

#include "psi_slam/frame.h"

namespace psi_slam {

/// The pose between two poses, `fraction` in [0, 1] of the way, turning the shorter way round.
mrpt::math::TPose2D interpolate(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to,
                                double fraction);

/// Gives scans the odometry of their own time where a log has odometry and scans as separate messages. A scan
/// waits until odometry at least as late has come, and is interpolated between it and the message before. A
/// scan that lies between no two messages in time gets the pose of one of its two neighbours in the log, the
/// one nearer in time. Scans leave in the order in which they came.
///
/// Where the time of odometry steps back, a clock was set: what came before is forgotten. The scans around
/// that place belong to the clock of the neighbour that is nearer in time; therefore a scan that steps back
/// waits for the message behind it.
class OdometryInterpolator {
 public:
  /// Scans that wait for odometry beyond this number wait no longer: odometry has stopped.
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

  /// A scan and the odometry next to it in the log.
  struct Scan {
    Frame frame;
    std::optional<Odometry> before;
    std::optional<Odometry> behind;
    bool steps_back = false;  // its time does
    bool is_placed = false;   // its odometry is final
  };

  static bool belongs_behind(const Scan& scan);
  bool must_wait(const Scan& scan) const;
  void place(Scan& scan) const;
  bool place_between_messages(Frame& frame) const;

  std::deque<Odometry> odometry_;  // since time stepped back last; never empty behind the first message
  std::deque<Scan> scans_;
  std::optional<TimeUs> last_scan_us_;
  bool ended_ = false;
};

}  // namespace psi_slam
