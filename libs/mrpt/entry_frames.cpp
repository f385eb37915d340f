// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/entry_frames.h"

#include <utility>

#include "frames/laser_choice.h"
#include "observations/mrpt_objects.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

EntryFrames::EntryFrames(const LogOptions& options, std::string speaker)
    : speaker_(std::move(speaker)),
      lasers_(options),
      several_lasers_(reads_several_lasers(options, LogFormat::kMrptRawlog)) {
  check_log_options(options);
}

void EntryFrames::take(const mrpt::obs::CActionCollection::Ptr& action,
                       const mrpt::obs::CSensoryFrame::Ptr& observations,
                       const mrpt::obs::CObservation::Ptr& observation) {
  if (action) {
    const std::optional<mrpt::math::TPose2D> motion = movement_of(*action);
    if (motion && odometry_ == Odometry::kUndecided) begin_with_actions();
    if (motion && odometry_ == Odometry::kActions) odom_T_robot_ = odom_T_robot_ + *motion;
  }
  if (observation) take(*observation);
  if (!observations) return;
  for (const mrpt::obs::CObservation::Ptr& one : *observations) take(*one);
}

std::optional<Frame> EntryFrames::next() {
  std::optional<Frame> frame;
  if (several_lasers_) {
    while (auto scan = next_scan()) synchronizer_.add(*std::move(scan));
    if (ended_) synchronizer_.end_of_log();
    frame = synchronizer_.take();
  } else {
    frame = next_scan();
  }
  if (!frame) return std::nullopt;
  opened_by_ = frame->index;
  frame->index = frames_++;
  return frame;
}

std::optional<Frame> EntryFrames::next_scan() {
  if (ready_.empty()) return waiting_.take();
  Frame frame = std::move(ready_.front());
  ready_.pop_front();
  return frame;
}

void EntryFrames::end_of_log() {
  if (odometry_ == Odometry::kUndecided && waiting_.waiting() > 0) throw_no_odometry(waiting_.waiting());
  waiting_.end_of_log();
  ended_ = true;
}

// Scans that came before the first action stand where the robot started.
void EntryFrames::begin_with_actions() {
  odometry_ = Odometry::kActions;
  waiting_.add_odometry(0, odom_T_robot_);
  waiting_.end_of_log();
  while (std::optional<Frame> frame = waiting_.take()) ready_.push_back(*std::move(frame));
  waiting_ = {};
}

void EntryFrames::take(const mrpt::obs::CObservation& observation) {
  if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation))
    take_scan(*scan);
  else if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation))
    take_odometry(*odometry);
}

void EntryFrames::take_scan(const mrpt::obs::CObservation2DRangeScan& observation) {
  const std::string what = speaker_ + "scan " + std::to_string(scans_ + 1);
  auto scan = lasers_.scan(observation, what);
  if (!scan) return;
  Frame frame;
  frame.index = scans_;
  frame.time_us = stamp_of(observation, what);
  frame.scan = *std::move(scan);
  frame.odom_T_robot = odom_T_robot_;
  if (odometry_ == Odometry::kUndecided && waiting_.waiting() == OdometryInterpolator::kMaxWaiting)
    throw_no_odometry(waiting_.waiting() + 1);
  ++scans_;
  if (odometry_ == Odometry::kActions)
    ready_.push_back(std::move(frame));
  else
    waiting_.add_scan(std::move(frame));
}

void EntryFrames::take_odometry(const mrpt::obs::CObservationOdometry& observation) {
  if (odometry_ == Odometry::kActions) return;
  if (!odometry_label_) odometry_label_ = observation.sensorLabel;
  if (observation.sensorLabel != *odometry_label_) return;
  odometry_ = Odometry::kObservations;
  waiting_.add_odometry(stamp_of(observation, speaker_ + "odometry"), observation.odometry.asTPose());
}

TimeUs EntryFrames::stamp_of(const mrpt::obs::CObservation& observation, const std::string& what) {
  const std::optional<TimeUs> stamp = time_us(observation);
  if (!stamp) throw UserError(what + " has no time stamp, expected one on every observation");
  return *stamp;
}

void EntryFrames::throw_no_odometry(std::size_t scans) const {
  throw UserError(speaker_ + "no odometry came with " + std::to_string(scans) +
                  " scans, expected actions of class CActionRobotMovement2D or observations of class "
                  "CObservationOdometry");
}

}  // namespace psi_slam
