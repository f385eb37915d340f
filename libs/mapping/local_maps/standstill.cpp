// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/standstill.h"

#include <algorithm>

#include "base/degrees.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/pose_tolerance.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kLeastScans = 50;
constexpr double kLeast_s = 10;
constexpr double kLeastStep_s = 0.25;
constexpr double kStepPerStandstill = 0.05;

constexpr PoseTolerance kOdometry{0.002, radians_from_degrees(0.1L)};
constexpr PoseTolerance kOneScan{0.02, radians_from_degrees(0.5L)};
constexpr PoseTolerance kMeanOfScans{0.005, radians_from_degrees(0.2L)};

}  // namespace

void Standstill::add(const Frame& frame, const TPose2D& local_T_robot, bool matched) {
  const bool goes_on = scans_ > 0 && frame.time_us >= last_kept_us_ && agrees_with_odometry(frame) &&
                       (matched ? confirm(local_T_robot) : has_odometry_);
  if (!goes_on) {
    scans_ = 0;
    since_us_ = frame.time_us;
    odom_T_robot_ = frame.odom_T_robot;
    has_odometry_ = frame.has_odometry;
    place_ = local_T_robot;
    recent_.assign(1, local_T_robot);
  }
  last_kept_us_ = frame.time_us;
  if (goes_on && !matched) return;
  ++scans_;
  place_ = interpolate(place_, local_T_robot, 1 / static_cast<double>(scans_));
}

bool Standstill::is_long(const Frame& frame) const {
  return scans_ >= kLeastScans && frame.time_us >= last_kept_us_ &&
         seconds(frame.time_us - since_us_) >= kLeast_s && agrees_with_odometry(frame);
}

bool Standstill::confirm(const TPose2D& local_T_robot) {
  recent_.push_back(local_T_robot);
  if (recent_.size() > kRecentScans) recent_.pop_front();
  TPose2D mean = recent_.front();
  double scans = 0;
  for (const TPose2D& pose : recent_) mean = interpolate(mean, pose, 1 / ++scans);
  const bool remains = is_same_place(local_T_robot, place_, kOneScan) &&
                       (recent_.size() < kRecentScans || is_same_place(mean, place_, kMeanOfScans));
  if (!remains) scans_ = 0;
  return remains;
}

bool Standstill::agrees_with_odometry(const Frame& frame) const {
  return frame.has_odometry == has_odometry_ &&
         (!has_odometry_ || is_same_place(frame.odom_T_robot, odom_T_robot_, kOdometry));
}

bool Standstill::keeps(TimeUs time_us) {
  const double step_s = std::max(kLeastStep_s, kStepPerStandstill * seconds(time_us - since_us_));
  if (seconds(time_us - last_kept_us_) < step_s) return false;
  last_kept_us_ = time_us;
  return true;
}

}  // namespace psi_slam
