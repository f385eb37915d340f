// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/scan_rays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace psi_slam {

using mrpt::math::TBoundingBox;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

const std::vector<const Fan*>& RayMaker::fans(const Frame& frame, const TPose2D& map_T_robot) {
  fans_.clear();
  for_each_scan(frame, map_T_robot, [&](const LaserScan& scan, const TPose2D& map_T_robot_then) {
    while (lasers_.size() <= scan.laser) lasers_.emplace_back();
    cast(scan, map_T_robot_then, lasers_[scan.laser]);
    fans_.push_back(&lasers_[scan.laser]);
  });
  return fans_;
}

void RayMaker::cast(const LaserScan& scan, const TPose2D& map_T_robot, Fan& fan) const {
  if (scan.bearings_rad != fan.bearings) {
    fan.bearings = scan.bearings_rad;
    fan.directions.clear();
    for (std::size_t i = 0; fan.bearings && i < fan.bearings->size(); ++i) {
      const double angle = static_cast<double>((*fan.bearings)[i]);
      fan.directions.emplace_back(std::cos(angle), std::sin(angle));
    }
  }
  const std::size_t beams = scan.ranges_m.size();
  if (fan.directions.size() != beams)
    throw std::invalid_argument("draw_grid_map: " + std::to_string(beams) + " ranges but " +
                                std::to_string(fan.directions.size()) + " bearings, expected equal numbers");
  const TPose2D map_T_laser = map_T_robot + scan.robot_T_laser;
  if (!std::isfinite(map_T_laser.x) || !std::isfinite(map_T_laser.y) || !std::isfinite(map_T_laser.phi))
    throw std::invalid_argument("draw_grid_map: the pose of a laser is not finite");
  const double c = std::cos(map_T_laser.phi);
  const double s = std::sin(map_T_laser.phi);
  const double clear_m = std::min(options_.no_return_clears_m, static_cast<double>(scan.max_range_m));
  fan.start = {map_T_laser.x, map_T_laser.y};
  fan.rays.clear();
  for (std::size_t i = 0; i < beams; ++i) {
    const double range_m = static_cast<double>(scan.ranges_m[i]);
    if (std::isnan(range_m)) continue;
    const double length = std::min(std::isinf(range_m) ? clear_m : range_m, options_.max_range_m);
    const TPoint2D& direction = fan.directions[i];
    fan.rays.push_back({{fan.start.x + length * (c * direction.x - s * direction.y),
                         fan.start.y + length * (s * direction.x + c * direction.y)},
                        range_m <= options_.max_range_m,
                        std::isfinite(range_m)});
  }
}

TBoundingBox bounds_of(const std::vector<const Fan*>& fans) {
  TBoundingBox bounds = TBoundingBox::PlusMinusInfinity();
  const auto include = [&](const TPoint2D& point) { bounds.updateWithPoint({point.x, point.y, 0}); };
  for (const Fan* fan : fans) {
    for (const Ray& ray : fan->rays) include(ray.end);
    include(fan->start);
  }
  return bounds;
}

}  // namespace psi_slam
