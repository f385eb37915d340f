// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/height_slice.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "base/text_parts.h"
#include "logs/frames/laser_readings.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kBeams = 720;

std::size_t sector_of(double bearing_rad) {
  const double sector = std::floor((bearing_rad + M_PI) * (kBeams / (2 * M_PI)));
  return static_cast<std::size_t>(std::clamp(sector, 0.0, static_cast<double>(kBeams - 1)));
}

}  // namespace

std::optional<HeightSlice> height_slice(const LogOptions& options) {
  if (trimmed(options.slice_z_m).empty()) return std::nullopt;
  std::istringstream words(options.slice_z_m);
  std::string low;
  std::string high;
  std::string surplus;
  words >> low >> high >> surplus;
  const auto low_m = parse_number(low);
  const auto high_m = parse_number(high);
  if (!low_m || !high_m || !surplus.empty() || !(*low_m < *high_m))
    throw UserError("log.slice_z_m is \"" + options.slice_z_m +
                    "\", expected two heights above the floor in metres, the lower one first, such as "
                    "\"0.1 1.0\"");
  return HeightSlice{*low_m, *high_m};
}

LaserScan scan_of_slice(const std::vector<mrpt::math::TPoint3Df>& points,
                        const mrpt::poses::CPose3D& robot_T_sensor, const HeightSlice& slice,
                        const LogOptions& options) {
  const mrpt::poses::CPose3D upside_down(0, 0, 0, 0, 0, M_PI);
  const mrpt::poses::CPose3D mount = options.mirrored ? robot_T_sensor + upside_down : robot_T_sensor;
  const mrpt::math::CMatrixDouble33 rotation = mount.getRotationMatrix();
  const double yaw_rad = portable::atan2(rotation(1, 0), rotation(0, 0));
  LaserScan scan;
  scan.robot_T_laser = options.robot_T_laser.value_or(mrpt::math::TPose2D(mount.x(), mount.y(), yaw_rad));
  scan.ranges_m.assign(kBeams, std::numeric_limits<float>::quiet_NaN());
  limit_ranges(scan, options, kUnstatedMaxRange_m);
  std::vector<float> bearings_rad = make_bearings_rad(BeamAngles::kCentredHalfStep, kBeams, 2 * M_PI);
  for (const mrpt::math::TPoint3Df& point : points) {
    double ahead[3];  // from the sensor to the point, along the axes of the robot
    for (int i = 0; i < 3; ++i)
      ahead[i] = rotation(i, 0) * static_cast<double>(point.x) +
                 rotation(i, 1) * static_cast<double>(point.y) +
                 rotation(i, 2) * static_cast<double>(point.z);
    const double height_m = mount.z() + ahead[2];
    const auto range_m = static_cast<float>(portable::hypot(ahead[0], ahead[1]));
    const bool is_in_slice = height_m >= slice.low_m && height_m <= slice.high_m;
    const bool is_in_range =
        range_m > 0 && static_cast<double>(range_m) >= options.min_range_m && range_m < scan.max_range_m;
    if (!is_in_slice || !is_in_range) continue;
    const double bearing_rad = mrpt::math::wrapToPi(portable::atan2(ahead[1], ahead[0]) - yaw_rad);
    const std::size_t beam = sector_of(bearing_rad);
    if (scan.ranges_m[beam] <= range_m) continue;
    scan.ranges_m[beam] = range_m;
    bearings_rad[beam] = static_cast<float>(bearing_rad);
  }
  scan.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings_rad));
  return scan;
}

}  // namespace psi_slam
