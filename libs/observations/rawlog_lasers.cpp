// SPDX-License-Identifier: BSD-3-Clause
#include "observations/rawlog_lasers.h"

#include <limits>
#include <memory>

#include "frames/beam_angles.h"
#include "frames/laser_readings.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

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
  if (beams == 0) throw UserError(place + ": the scan has 0 rays, expected 1 or more");
  const FloorMount mount = floor_mount(observation.sensorPose, place);
  const bool clockwise = (mount.upside_down == observation.rightToLeft) != options_.mirrored;
  const auto aperture_rad = static_cast<double>(observation.aperture);
  const std::tuple geometry{beams, aperture_rad, clockwise};
  if (!bearings_ || geometry != geometry_) {
    bearings_ = std::make_shared<const std::vector<float>>(bearings_rad(beams, aperture_rad, clockwise));
    geometry_ = geometry;
  }

  LaserScan scan;
  scan.bearings_rad = bearings_;
  scan.robot_T_laser = options_.robot_T_laser.value_or(mount.robot_T_laser);
  scan.ranges_m.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    scan.ranges_m[i] = observation.getScanRangeValidity(i) ? observation.getScanRange(i)
                                                           : std::numeric_limits<float>::quiet_NaN();
  }
  limit_ranges(scan, options_, static_cast<double>(observation.maxRange));
  return scan;
}

RawlogLasers::RawlogLasers(const LogOptions& options)
    : options_(options), chosen_(laser_choice("log.laser", options.laser)) {}

std::optional<LaserScan> RawlogLasers::scan(const mrpt::obs::CObservation2DRangeScan& observation,
                                            const std::string& place) {
  const auto number = chosen_.number_of(observation.sensorLabel);
  if (!number) return std::nullopt;
  LaserScan scan = laser(*number, observation, place).reader.scan(observation, place);
  scan.laser = *number;
  return scan;
}

RawlogLasers::Laser& RawlogLasers::laser(std::size_t number, const mrpt::obs::CObservation2DRangeScan& first,
                                         const std::string& place) {
  if (const auto known = lasers_.find(number); known != lasers_.end()) return known->second;
  const LogOptions own = options_of_laser(options_, {first.sensorLabel});
  const Laser added{first.sensorLabel, RawlogLaser(own), first.sensorPose, own.robot_T_laser.has_value()};
  for (const auto& [other_number, other] : lasers_)
    if (!added.is_stated && !other.is_stated && added.robot_T_sensor == other.robot_T_sensor)
      throw UserError(
          place + ": the lasers \"" + other.label + "\" and \"" + added.label +
          "\" have the same pose on the robot. State their mounts with log.laser_mounts, such as \"" +
          added.label + " -0.3 0 180\" (metres, degrees)");
  return lasers_.emplace(number, added).first->second;
}

}  // namespace psi_slam
