// SPDX-License-Identifier: BSD-3-Clause
#include "frames/laser_readings.h"

#include <mrpt/core/bits_math.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

const double kMaxTilt_rad = mrpt::DEG2RAD(15.0);

/// Angle between the laser's plane and the floor, in [0, pi/2].
double tilt_rad(const mrpt::math::CMatrixDouble33& rotation) {
  return std::acos(std::min(1.0, std::abs(rotation(2, 2))));
}

}  // namespace

FloorMount floor_mount(const mrpt::poses::CPose3D& robot_T_laser, const std::string& place) {
  const mrpt::math::CMatrixDouble33 rotation = robot_T_laser.getRotationMatrix();
  if (tilt_rad(rotation) > kMaxTilt_rad)
    throw UserError(place + ": the laser is tilted by " +
                    std::to_string(std::lround(mrpt::RAD2DEG(tilt_rad(rotation)))) +
                    " degrees, expected at most 15. Select another laser with log.laser");
  return {{robot_T_laser.x(), robot_T_laser.y(), std::atan2(rotation(1, 0), rotation(0, 0))},
          rotation(2, 2) < 0};
}

void mirror(std::vector<float>& bearings_rad) {
  for (float& bearing : bearings_rad) bearing = -bearing;
}

void mark_no_returns(std::vector<float>& ranges_m, double min_range_m, double max_range_m) {
  // Both sides are single precision: a reading written as "50.00" must equal a maximum of 50.00.
  const auto min_range = static_cast<float>(min_range_m);
  const auto max_range = static_cast<float>(max_range_m);
  for (float& range : ranges_m) {
    const bool is_return = range > 0 && range >= min_range && range < max_range;
    if (!is_return) range = std::numeric_limits<float>::quiet_NaN();
  }
}

void limit_ranges(LaserScan& scan, const LogOptions& options, double stated_max_range_m,
                  double stated_min_range_m) {
  scan.max_range_m = static_cast<float>(
      options.max_range_m.value_or(stated_max_range_m > 0 ? stated_max_range_m : kUnstatedMaxRange_m));
  mark_no_returns(scan.ranges_m, std::max(options.min_range_m, stated_min_range_m),
                  static_cast<double>(scan.max_range_m));
}

}  // namespace psi_slam
