// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/ros_laser.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "frames/beam_angles.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Sweep time, or 0 if the stated one is implausible: drivers may leave it 0, or state more than the time
/// between scans or than any laser needs.
float sweep_time_s(const RosLaserScan& message) {
  constexpr float kMaxSweep_s = 1;
  const float sweep_s = message.time_increment_s * static_cast<float>(message.ranges_m.size() - 1);
  const float max_sweep_s =
      message.scan_time_s > 0 ? std::min(kMaxSweep_s, 1.5F * message.scan_time_s) : kMaxSweep_s;
  return sweep_s > 0 && sweep_s <= max_sweep_s ? sweep_s : 0;
}

}  // namespace

bool RosLaser::Geometry::operator==(const Geometry& other) const {
  return beams == other.beams && angle_min_rad == other.angle_min_rad &&
         angle_increment_rad == other.angle_increment_rad && clockwise == other.clockwise;
}

std::vector<float> RosLaser::bearings_rad(const Geometry& geometry) const {
  const auto step_rad = static_cast<double>(geometry.angle_increment_rad);
  std::vector<float> bearings;
  if (options_.beam_angles == BeamAngles::kAuto && !options_.field_of_view_rad) {
    bearings.resize(geometry.beams);
    for (std::size_t i = 0; i < geometry.beams; ++i)
      bearings[i] =
          static_cast<float>(static_cast<double>(geometry.angle_min_rad) + static_cast<double>(i) * step_rad);
  } else {
    const bool is_auto = options_.beam_angles == BeamAngles::kAuto;
    const double steps = static_cast<double>(std::max<std::size_t>(geometry.beams - 1, 1));
    const double span_rad = std::min(std::abs(step_rad) * steps, 2 * M_PI);
    bearings = make_bearings_rad(is_auto ? BeamAngles::kCentredStepInclusive : options_.beam_angles,
                                 geometry.beams, options_.field_of_view_rad.value_or(span_rad));
    if (step_rad < 0) mirror(bearings);
  }
  if (geometry.clockwise) mirror(bearings);
  return bearings;
}

LaserScan RosLaser::scan(RosLaserScan message, const FloorMount& mount, const std::string& place) {
  const Geometry geometry{message.ranges_m.size(), message.angle_min_rad, message.angle_increment_rad,
                          mount.upside_down != options_.mirrored};
  const bool has_angles = std::isfinite(geometry.angle_min_rad) &&
                          std::isfinite(geometry.angle_increment_rad) &&
                          (geometry.beams < 2 || geometry.angle_increment_rad != 0);
  if (!has_angles)
    throw UserError(place + ": the scan's angles start at " + std::to_string(geometry.angle_min_rad) +
                    " in steps of " + std::to_string(geometry.angle_increment_rad) +
                    " radians, expected finite angles and a step other than 0");
  if (!bearings_ || !(geometry == geometry_)) {
    bearings_ = std::make_shared<const std::vector<float>>(bearings_rad(geometry));
    geometry_ = geometry;
  }
  LaserScan scan;
  scan.bearings_rad = bearings_;
  scan.robot_T_laser = options_.robot_T_laser.value_or(mount.robot_T_laser);
  scan.sweep_time_s = sweep_time_s(message);
  scan.ranges_m = std::move(message.ranges_m);
  limit_ranges(scan, options_,
               std::isfinite(message.range_max_m) ? static_cast<double>(message.range_max_m) : 0,
               static_cast<double>(message.range_min_m));
  return scan;
}

}  // namespace psi_slam
