// SPDX-License-Identifier: BSD-3-Clause
#include "observations/rawlog_laser.h"

#include <limits>
#include <memory>

#include "psi_slam/user_error.h"
#include "frames/floor_mount.h"
#include "frames/range_filter.h"

namespace psi_slam {

std::vector<float> RawlogLaser::bearings_rad(std::size_t beams, double aperture_rad, bool clockwise) const {
  const bool as_the_log_says = options_.beam_angles == BeamAngles::kAuto;
  const BeamAngles angles = as_the_log_says ? BeamAngles::kCentredStepInclusive : options_.beam_angles;
  std::vector<float> bearings =
      make_bearings_rad(angles, beams, options_.field_of_view_rad.value_or(aperture_rad));
  if (clockwise)
    for (float& bearing : bearings) bearing = -bearing;
  return bearings;
}

LaserScan RawlogLaser::scan(const mrpt::obs::CObservation2DRangeScan& observation, const std::string& place) {
  const std::size_t beams = observation.getScanSize();
  if (beams == 0) throw UserError(place + ": the scan has 0 rays, expected 1 or more");
  const FloorMount mount = floor_mount(observation.sensorPose, place);
  const bool clockwise = (mount.upside_down == observation.rightToLeft) != options_.mirrored;
  const auto aperture_rad = static_cast<double>(observation.aperture);
  if (!bearings_ || beams != beams_ || aperture_rad != aperture_rad_ || clockwise != clockwise_) {
    bearings_ = std::make_shared<const std::vector<float>>(bearings_rad(beams, aperture_rad, clockwise));
    beams_ = beams;
    aperture_rad_ = aperture_rad;
    clockwise_ = clockwise;
  }

  LaserScan scan;
  scan.bearings_rad = bearings_;
  scan.robot_T_laser = options_.robot_T_laser.value_or(mount.robot_T_laser);
  const bool states_maximum = observation.maxRange > 0;
  scan.max_range_m = static_cast<float>(options_.max_range_m.value_or(
      states_maximum ? static_cast<double>(observation.maxRange) : kUnstatedMaxRange_m));
  scan.ranges_m.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    scan.ranges_m[i] = observation.getScanRangeValidity(i) ? observation.getScanRange(i)
                                                           : std::numeric_limits<float>::quiet_NaN();
  }
  mark_no_returns(scan.ranges_m, options_.min_range_m, static_cast<double>(scan.max_range_m));
  return scan;
}

}  // namespace psi_slam
