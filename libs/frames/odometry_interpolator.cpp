// SPDX-License-Identifier: BSD-3-Clause
#include "frames/odometry_interpolator.h"

#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <utility>

namespace psi_slam {
namespace {

constexpr std::size_t kKeptMessages = 1000;  // behind the newest, when no scan asks for them

}  // namespace

mrpt::math::TPose2D interpolate(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to,
                                double fraction) {
  const double turn_rad = mrpt::math::wrapToPi(to.phi - from.phi);
  return {from.x + fraction * (to.x - from.x), from.y + fraction * (to.y - from.y),
          mrpt::math::wrapToPi(from.phi + fraction * turn_rad)};
}

void OdometryInterpolator::add_odometry(TimeUs time_us, const mrpt::math::TPose2D& odom_T_robot) {
  const Odometry message{time_us, odom_T_robot};
  const bool clock_was_set = !odometry_.empty() && time_us < odometry_.back().time_us;
  for (Scan& scan : scans_) {
    const bool is_next_to_it = !scan.behind;
    if (is_next_to_it) scan.behind = message;
    const bool is_of_new_clock = is_next_to_it && belongs_behind(scan);
    if (clock_was_set && !scan.is_placed && !is_of_new_clock) place(scan);
  }
  if (clock_was_set) odometry_.clear();
  odometry_.push_back(message);
  while (odometry_.size() > kKeptMessages) odometry_.pop_front();
}

void OdometryInterpolator::add_scan(Frame frame) {
  Scan scan;
  if (!odometry_.empty()) scan.before = odometry_.back();
  scan.steps_back = (last_scan_us_ && frame.time_us < *last_scan_us_) ||
                    (!odometry_.empty() && frame.time_us < odometry_.front().time_us);
  last_scan_us_ = frame.time_us;
  scan.frame = std::move(frame);
  scans_.push_back(std::move(scan));
}

bool OdometryInterpolator::belongs_behind(const Scan& scan) {
  if (!scan.before || !scan.behind) return scan.behind.has_value();
  const auto distance_s = [&](const Odometry& message) {
    return std::abs(seconds(message.time_us) - seconds(scan.frame.time_us));
  };
  return distance_s(*scan.behind) < distance_s(*scan.before);
}

void OdometryInterpolator::place(Scan& scan) const {
  if (!place_between_messages(scan.frame))
    scan.frame.odom_T_robot = (belongs_behind(scan) ? scan.behind : scan.before)->odom_T_robot;
  scan.is_placed = true;
}

bool OdometryInterpolator::place_between_messages(Frame& frame) const {
  // Searched from the newest on: stamps may run backwards, and then the order of the file decides.
  for (std::size_t i = odometry_.size(); i-- > 1;) {
    const Odometry& before = odometry_[i - 1];
    const Odometry& after = odometry_[i];
    if (frame.time_us < before.time_us || frame.time_us > after.time_us) continue;
    const TimeUs span_us = after.time_us - before.time_us;
    const double fraction =
        span_us > 0 ? static_cast<double>(frame.time_us - before.time_us) / static_cast<double>(span_us)
                    : 1.0;
    frame.odom_T_robot = interpolate(before.odom_T_robot, after.odom_T_robot, fraction);
    return true;
  }
  return false;
}

bool OdometryInterpolator::must_wait(const Scan& scan) const {
  if (scan.is_placed || ended_ || scans_.size() > kMaxWaiting) return false;
  return scan.frame.time_us > odometry_.back().time_us || (scan.steps_back && !scan.behind);
}

std::optional<Frame> OdometryInterpolator::take() {
  if (scans_.empty() || odometry_.empty() || must_wait(scans_.front())) return std::nullopt;
  Scan scan = std::move(scans_.front());
  scans_.pop_front();
  if (!scan.is_placed) place(scan);
  return std::move(scan.frame);
}

}  // namespace psi_slam
