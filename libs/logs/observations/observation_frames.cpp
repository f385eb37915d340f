// SPDX-License-Identifier: BSD-3-Clause
#include "logs/observations/observation_frames.h"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "logs/frames/laser_readings.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/pose_operations.h"
#include "logs/observations/cloud_points.h"
#include "logs/observations/mrpt_objects.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

TimeUs stamp_of(const mrpt::obs::CObservation& observation, const char* what, const std::string& place) {
  if (const std::optional<TimeUs> stamp = time_us(observation)) return *stamp;
  throw UserError(place + ": the " + what +
                  " has no time stamp, expected one on every observation. Record the log with time stamps");
}

mrpt::poses::CPose3D sensor_pose_of(const mrpt::obs::CObservation& observation) {
  mrpt::poses::CPose3D robot_T_sensor;
  observation.getSensorPose(robot_T_sensor);
  return robot_T_sensor;
}

}  // namespace

std::vector<float> RawlogLaser::bearings_rad(std::size_t beams, double aperture_rad, bool clockwise) const {
  const bool is_auto = options_.beam_angles == BeamAngles::kAuto;
  const BeamAngles angles = is_auto ? BeamAngles::kCentredStepInclusive : options_.beam_angles;
  std::vector<float> bearings =
      make_bearings_rad(angles, beams, options_.field_of_view_rad.value_or(aperture_rad));
  if (clockwise) mirror(bearings);
  return bearings;
}

LaserScan RawlogLaser::scan(const mrpt::obs::CObservation2DRangeScan& observation, const std::string& place) {
  const std::size_t beams = observation.getScanSize();
  if (beams == 0)
    throw UserError(place + ": the scan has 0 rays, expected 1 or more. Remove the scan from the log");
  const FloorMount mount = floor_mount(observation.sensorPose, place);
  const bool clockwise = (mount.upside_down == observation.rightToLeft) != options_.mirrored;
  const auto aperture_rad = static_cast<double>(observation.aperture);
  const std::tuple geometry{beams, aperture_rad, clockwise};
  if (!bearings_ || geometry != geometry_) {
    if (const auto fault = fault_of_beams(beams, 0, aperture_rad / static_cast<double>(beams)))
      throw UserError(place + ": " + *fault);
    bearings_ = std::make_shared<const std::vector<float>>(bearings_rad(beams, aperture_rad, clockwise));
    geometry_ = geometry;
  }

  LaserScan scan;
  scan.bearings_rad = bearings_;
  scan.robot_T_laser = options_.robot_T_laser.value_or(mount.robot_T_laser);
  scan.ranges_m.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const float range_m = observation.getScanRange(i);
    // MRPT also marks a ray without return as invalid, but with the maximum range.
    const bool is_reading =
        observation.getScanRangeValidity(i) || (observation.maxRange > 0 && range_m >= observation.maxRange);
    scan.ranges_m[i] = is_reading ? range_m : std::numeric_limits<float>::quiet_NaN();
  }
  limit_ranges(scan, options_, static_cast<double>(observation.maxRange));
  return scan;
}

bool is_scan(const mrpt::obs::CObservation& observation, bool slices) {
  return slices ? is_cloud(observation)
                : dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation) != nullptr;
}

std::optional<LaserScan> RawlogLasers::scan(const mrpt::obs::CObservation& observation,
                                            const std::string& place) {
  const auto number =
      is_scan(observation, slice_.has_value()) ? chosen_.number_of(observation.sensorLabel) : std::nullopt;
  if (!number) return std::nullopt;
  Laser& own = laser(*number, observation, place);
  LaserScan scan =
      slice_
          ? scan_of_slice(cloud_points(observation, place), sensor_pose_of(observation), *slice_, own.options)
          : own.reader.scan(dynamic_cast<const mrpt::obs::CObservation2DRangeScan&>(observation), place);
  scan.laser = *number;
  return scan;
}

RawlogLasers::Laser& RawlogLasers::laser(std::size_t number, const mrpt::obs::CObservation& first,
                                         const std::string& place) {
  if (const auto known = lasers_.find(number); known != lasers_.end()) return known->second;
  const LogOptions own = options_of_laser(options_, {first.sensorLabel});
  const Laser added{first.sensorLabel, own, RawlogLaser(own), sensor_pose_of(first),
                    own.robot_T_laser.has_value()};
  for (const auto& [other_number, other] : lasers_)
    if (!added.is_stated && !other.is_stated && added.robot_T_sensor == other.robot_T_sensor)
      throw MissingMount(
          place + ": the lasers \"" + other.label + "\" and \"" + added.label +
          "\" have the same pose on the robot. State their mounts with log.laser_mounts, such as \"" +
          added.label + " -0.3 0 180\" (metres, degrees)");
  return lasers_.emplace(number, added).first->second;
}

bool has_rate(const mrpt::obs::CObservationIMU& imu) {
  return imu.has(mrpt::obs::IMU_WZ);
}

ObservationFrames::ObservationFrames(const LogOptions& options, Odometry odometry,
                                     std::optional<std::string> gyroscope, std::size_t most_waiting)
    : lasers_(options),
      slices_clouds_(height_slice(options).has_value()),
      odometry_(odometry),
      gyroscope_(std::move(gyroscope)),
      waiting_(most_waiting) {
  if (ignores_odometry(options) || odometry == Odometry::kNone) decide_for_none();
}

void ObservationFrames::decide_for_none() {
  odometry_ = Odometry::kNone;
  waiting_.expect_no_odometry();
}

void ObservationFrames::skip(const std::string& place) {
  if (skipped_.count++ == 0) skipped_.first = place + ": the odometry is not finite, or beyond 10,000 km";
}

void ObservationFrames::take(const mrpt::obs::CActionCollection& action, const std::string& place) {
  const std::optional<mrpt::math::TPose2D> motion = movement_of(action);
  if (motion && odometry_ == Odometry::kUndecided) {
    odometry_ = Odometry::kActions;
    waiting_.add_odometry(0, odom_T_robot_);  // scans before the first action are at the origin
    waiting_.end_of_log();
    while (std::optional<Frame> frame = waiting_.take()) ready_.push_back(*std::move(frame));
    waiting_ = {};
  }
  if (!motion || odometry_ != Odometry::kActions) return;
  if (is_possible_odometry(*motion)) {
    odom_T_robot_ = compose(odom_T_robot_, *motion);
  } else {
    is_motion_unknown_ = true;
    skip(place);
  }
}

void ObservationFrames::take(const mrpt::obs::CObservation& observation, const std::string& place) {
  if (is_scan(observation, slices_clouds_))
    take_scan(observation, place);
  else if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation))
    take_odometry(*odometry, place);
  else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation))
    take_imu(*imu);
}

void ObservationFrames::take_scan(const mrpt::obs::CObservation& observation, const std::string& place) {
  auto scan = lasers_.scan(observation, place);
  if (!scan) return;
  Frame frame;
  frame.index = scans_;
  frame.time_us = stamp_of(observation, "scan", place);
  frame.scan = *std::move(scan);
  frame.odom_T_robot = odom_T_robot_;
  frame.has_odometry = !std::exchange(is_motion_unknown_, false);
  if (odometry_ == Odometry::kUndecided && waiting_.waiting() == OdometryInterpolator::kMaxWaiting)
    decide_for_none();
  ++scans_;
  if (uses_gyroscope()) frame.has_odometry = false;
  if (odometry_ == Odometry::kActions)
    ready_.push_back(std::move(frame));
  else if (uses_gyroscope())
    headings_.add_scan(std::move(frame));
  else
    waiting_.add_scan(std::move(frame));
}

void ObservationFrames::take_odometry(const mrpt::obs::CObservationOdometry& observation,
                                      const std::string& place) {
  if (odometry_ == Odometry::kActions || odometry_ == Odometry::kNone) return;
  if (!odometry_label_) odometry_label_ = observation.sensorLabel;
  if (observation.sensorLabel != *odometry_label_) return;
  if (!is_possible_odometry(observation.odometry.asTPose())) return skip(place);
  odometry_ = Odometry::kObservations;
  waiting_.add_odometry(stamp_of(observation, "odometry", place), observation.odometry.asTPose());
}

void ObservationFrames::take_imu(const mrpt::obs::CObservationIMU& observation) {
  using mrpt::obs::TIMUDataIndex;
  if (!uses_gyroscope() || observation.sensorLabel != *gyroscope_ || !has_rate(observation)) return;
  const auto rate = [&](TIMUDataIndex axis) { return observation.has(axis) ? observation.get(axis) : 0; };
  const std::optional<TimeUs> stamp = time_us(observation);
  if (stamp)
    headings_.add_rate(
        *stamp, vertical_rate_radps(observation.sensorPose, {rate(mrpt::obs::IMU_WX), rate(mrpt::obs::IMU_WY),
                                                             rate(mrpt::obs::IMU_WZ)}));
}

std::optional<Frame> ObservationFrames::next() {
  if (uses_gyroscope()) return headings_.take();
  if (ready_.empty()) return waiting_.take();
  Frame frame = std::move(ready_.front());
  ready_.pop_front();
  return frame;
}

void ObservationFrames::end_of_log() {
  if (odometry_ == Odometry::kUndecided) decide_for_none();
  waiting_.end_of_log();
  headings_.end_of_log();
}

}  // namespace psi_slam
