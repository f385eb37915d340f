// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/odometry_interpolator.h"

#include <mrpt/math/wrap2pi.h>

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
  odometry_.push_back({time_us, odom_T_robot});
  while (odometry_.size() > kKeptMessages) odometry_.pop_front();
}

void OdometryInterpolator::add_scan(Frame frame) {
  scans_.push_back(std::move(frame));
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

std::optional<Frame> OdometryInterpolator::take() {
  if (scans_.empty() || odometry_.empty()) return std::nullopt;
  Frame& frame = scans_.front();
  const bool wait = frame.time_us > odometry_.back().time_us && !ended_ && scans_.size() <= kMaxWaiting;
  if (wait) return std::nullopt;
  if (!place_between_messages(frame)) {
    const bool is_early = frame.time_us < odometry_.front().time_us;
    frame.odom_T_robot = (is_early ? odometry_.front() : odometry_.back()).odom_T_robot;
  }
  Frame ready = std::move(frame);
  scans_.pop_front();
  return ready;
}

}  // namespace psi_slam
