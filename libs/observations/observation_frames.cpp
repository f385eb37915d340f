// SPDX-License-Identifier: BSD-3-Clause
#include "observations/observation_frames.h"

#include <utility>

#include "observations/mrpt_objects.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

TimeUs stamp_of(const mrpt::obs::CObservation& observation, const char* what, const std::string& place) {
  if (const std::optional<TimeUs> stamp = time_us(observation)) return *stamp;
  throw UserError(place + ": the " + what + " has no time stamp, expected one on every observation");
}

[[noreturn]] void throw_no_odometry(std::size_t scans, const std::string& place) {
  throw UserError(place + ": no odometry came with " + std::to_string(scans) +
                  " scans, expected actions of class CActionRobotMovement2D or observations of class "
                  "CObservationOdometry");
}

}  // namespace

ObservationFrames::ObservationFrames(const LogOptions& options, Odometry odometry)
    : lasers_(options), odometry_(odometry) {}

void ObservationFrames::take(const mrpt::obs::CActionCollection& action) {
  const std::optional<mrpt::math::TPose2D> motion = movement_of(action);
  if (motion && odometry_ == Odometry::kUndecided) begin_with_actions();
  if (motion && odometry_ == Odometry::kActions) odom_T_robot_ = odom_T_robot_ + *motion;
}

// Scans before the first action are at the start.
void ObservationFrames::begin_with_actions() {
  odometry_ = Odometry::kActions;
  waiting_.add_odometry(0, odom_T_robot_);
  waiting_.end_of_log();
  while (std::optional<Frame> frame = waiting_.take()) ready_.push_back(*std::move(frame));
  waiting_ = {};
}

void ObservationFrames::take(const mrpt::obs::CObservation& observation, const std::string& place) {
  if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation))
    take_scan(*scan, place);
  else if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation))
    take_odometry(*odometry, place);
}

void ObservationFrames::take_scan(const mrpt::obs::CObservation2DRangeScan& observation,
                                  const std::string& place) {
  auto scan = lasers_.scan(observation, place);
  if (!scan) return;
  Frame frame;
  frame.index = scans_;
  frame.time_us = stamp_of(observation, "scan", place);
  frame.scan = *std::move(scan);
  frame.odom_T_robot = odom_T_robot_;
  if (odometry_ == Odometry::kUndecided && waiting_.waiting() == OdometryInterpolator::kMaxWaiting)
    throw_no_odometry(waiting_.waiting() + 1, place);
  ++scans_;
  if (odometry_ == Odometry::kActions)
    ready_.push_back(std::move(frame));
  else
    waiting_.add_scan(std::move(frame));
}

void ObservationFrames::take_odometry(const mrpt::obs::CObservationOdometry& observation,
                                      const std::string& place) {
  if (odometry_ == Odometry::kActions) return;
  if (!odometry_label_) odometry_label_ = observation.sensorLabel;
  if (observation.sensorLabel != *odometry_label_) return;
  odometry_ = Odometry::kObservations;
  waiting_.add_odometry(stamp_of(observation, "odometry", place), observation.odometry.asTPose());
}

std::optional<Frame> ObservationFrames::next() {
  if (ready_.empty()) return waiting_.take();
  Frame frame = std::move(ready_.front());
  ready_.pop_front();
  return frame;
}

void ObservationFrames::end_of_log(const std::string& place) {
  if (odometry_ == Odometry::kUndecided && waiting_.waiting() > 0)
    throw_no_odometry(waiting_.waiting(), place);
  waiting_.end_of_log();
}

}  // namespace psi_slam
