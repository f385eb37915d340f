// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <deque>
#include <map>
#include <optional>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Returns the rate of turn about the vertical axis of the robot, radians per second, counter-clockwise
/// positive. `rate_radps` is the angular velocity along the axes of the gyroscope. Ignores axes that are
/// horizontal on the robot, so their rates may be NaN.
double vertical_rate_radps(const mrpt::poses::CPose3D& robot_T_gyroscope,
                           const mrpt::math::TVector3D& rate_radps);

/// Integrates the rate of a gyroscope by the trapezoidal rule, and sets Frame::imu_heading_rad of scans
/// without odometry by interpolation at the time of each scan. A scan waits until a rate of its time or later
/// has arrived. take() returns scans in the order of the log.
///
/// Only the difference between the headings of successive scans is meaningful, so the constant bias of a
/// gyroscope adds up over the time between two scans only. If rates are missing for more than `kMaxGap_s`, or
/// if the clock was set back, the turn is unknown. Then the scans in the gap and the first scan of each laser
/// after the gap have no heading. IMUs without a gyroscope may report zero, so scans have no heading before
/// the first rate other than zero.
class GyroscopeHeadings {
 public:
  /// Largest time between two rates, seconds, over which the rate is integrated.
  static constexpr double kMaxGap_s = 0.5;
  /// A scan no longer waits for rates if a later scan is this many seconds later: rates may have stopped, or
  /// have other clocks.
  static constexpr double kMaxWait_s = 1.0;
  /// Rates above this limit are faults, because no gyroscope measures them.
  static constexpr double kMaxRate_radps = 50.0;

  /// Adds the rate about the vertical, radians per second. Ignores rates that are not finite or too large,
  /// and rates that are slightly older than the last.
  void add_rate(TimeUs time_us, double rate_radps);
  void add_scan(Frame frame) { scans_.push_back(std::move(frame)); }
  void end_of_log() { ended_ = true; }

  /// Returns the next scan if its heading is known, or if it will never be known.
  std::optional<Frame> take();

 private:
  struct Sample {
    TimeUs time_us = 0;
    double rate_radps = 0;
    double heading_rad = 0;
    std::size_t part = 0;  // number of gaps before this sample
  };

  std::optional<Sample> sample_at(TimeUs time_us) const;
  bool must_wait(const Frame& scan) const;

  std::deque<Sample> samples_;  // in the order of time
  std::deque<Frame> scans_;
  std::map<std::size_t, std::size_t> last_parts_;  // part of the last scan of each laser, if it has a heading
  bool measures_ = false;                          // whether a rate was other than 0
  bool ended_ = false;
};

}  // namespace psi_slam
