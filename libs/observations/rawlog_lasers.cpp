// SPDX-License-Identifier: BSD-3-Clause
#include "observations/rawlog_lasers.h"

#include "psi_slam/user_error.h"

namespace psi_slam {

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
      throw UserError(place + ": the lasers \"" + other.label + "\" and \"" + added.label +
                      "\" have the same pose on the robot, which several lasers at once cannot; expected "
                      "log.laser_mounts to tell, such as \"" +
                      added.label + " -0.3 0 180\" (metres, degrees)");
  return lasers_.emplace(number, added).first->second;
}

}  // namespace psi_slam
