// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/odometry_interpolator.h"

#include <cmath>
#include <utility>

#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

constexpr std::size_t kKeptMessages = 1000;

}  // namespace

void OdometryInterpolator::add_odometry(TimeUs time_us, const mrpt::math::TPose2D& odom_T_robot) {
  if (!expects_odometry_) return;
  const Odometry message{time_us, odom_T_robot};
  const bool clock_was_set = !odometry_.empty() && time_us < odometry_.back().time_us;
  for (Scan& scan : scans_) {
    const bool is_next_message = !scan.after;
    if (is_next_message) scan.after = message;
    const bool is_of_new_clock = is_next_message && belongs_to_next_message(scan);
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

bool OdometryInterpolator::belongs_to_next_message(const Scan& scan) {
  if (!scan.before || !scan.after) return scan.after.has_value();
  const auto distance_s = [&](const Odometry& message) {
    return std::abs(seconds(message.time_us) - seconds(scan.frame.time_us));
  };
  return distance_s(*scan.after) < distance_s(*scan.before);
}

void OdometryInterpolator::place(Scan& scan) const {
  // If stamps run backwards, another pair of messages may enclose this stamp, too.
  if (scan.before && scan.before->time_us == scan.frame.time_us)
    scan.frame.odom_T_robot = scan.before->odom_T_robot;
  else if (scan.after && scan.after->time_us == scan.frame.time_us)
    scan.frame.odom_T_robot = scan.after->odom_T_robot;
  else if (!place_between_messages(scan.frame))
    scan.frame.odom_T_robot = (belongs_to_next_message(scan) ? scan.after : scan.before)->odom_T_robot;
  scan.is_placed = true;
}

bool OdometryInterpolator::place_between_messages(Frame& frame) const {
  // The search starts at the newest message, which is usually the nearest in time.
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
  if (scan.is_placed || ended_ || scans_.size() > most_waiting_) return false;
  return scan.frame.time_us > odometry_.back().time_us || (scan.steps_back && !scan.after);
}

std::optional<Frame> OdometryInterpolator::take() {
  const bool is_ready =
      !scans_.empty() && (!expects_odometry_ || (!odometry_.empty() && !must_wait(scans_.front())));
  if (!is_ready) return std::nullopt;
  Scan scan = std::move(scans_.front());
  scans_.pop_front();
  scan.frame.has_odometry = expects_odometry_;
  if (expects_odometry_ && !scan.is_placed) place(scan);
  return std::move(scan.frame);
}

}  // namespace psi_slam
