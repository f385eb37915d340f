// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/corrected_odometry_source.h"

#include <cmath>
#include <utility>

#include "logs/frames/laser_choice.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr auto kMostDelay_us = static_cast<TimeUs>(1e6 * kMostScanDelay_s);

}  // namespace

CorrectedOdometrySource::CorrectedOdometrySource(std::unique_ptr<FrameSource> source, double scale,
                                                 DelayOfLaser delay_s)
    : source_(std::move(source)), scale_(scale), delay_s_(std::move(delay_s)) {}

void CorrectedOdometrySource::find_delay(std::size_t laser) {
  if (delays_us_.count(laser) > 0) return;
  const TimeUs delay_us = std::llround(1e6 * delay_s_(laser));
  delays_us_[laser] = delay_us;
}

void CorrectedOdometrySource::correct(Frame& frame) const {
  if (!frame.has_odometry) return;
  if (delay_us(frame) != 0) frame.odom_T_robot = track_.at(frame.time_us - delay_us(frame));
  frame.odom_T_robot.x *= scale_;
  frame.odom_T_robot.y *= scale_;
}

bool CorrectedOdometrySource::must_wait(const Frame& frame) const {
  return frame.has_odometry && delay_us(frame) != 0 && !ended_ && waiting_.size() <= kMaxWaiting &&
         track_.end_us() < frame.time_us - delay_us(frame) + OdometryTrack::kMostOvertaking_us;
}

void CorrectedOdometrySource::read_ahead() {
  std::optional<Frame> frame;
  try {
    frame = source_->next();
  } catch (const UserError&) {
    failure_ = std::current_exception();
  }
  if (!frame) {
    ended_ = true;
    return;
  }
  if (frame->has_odometry) {
    find_delay(frame->scan.laser);
    if (track_.ends_before(frame->time_us)) {
      for (; corrected_ < waiting_.size(); ++corrected_) correct(waiting_[corrected_]);
      track_ = OdometryTrack();
    }
    track_.add(frame->time_us, frame->odom_T_robot);
  }
  waiting_.push_back(*std::move(frame));
}

std::optional<Frame> CorrectedOdometrySource::next() {
  while (!ended_ && (waiting_.empty() || (corrected_ == 0 && must_wait(waiting_.front())))) read_ahead();
  if (waiting_.empty()) {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::nullopt;
  }
  Frame frame = std::move(waiting_.front());
  waiting_.pop_front();
  if (corrected_ > 0) {
    --corrected_;
    return frame;
  }
  correct(frame);
  // A later frame of another laser may be up to kMostOvertaking_us earlier.
  if (frame.has_odometry)
    track_.forget_before(frame.time_us - kMostDelay_us - OdometryTrack::kMostOvertaking_us);
  return frame;
}

}  // namespace psi_slam
