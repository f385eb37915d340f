// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/scan_rays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "base/portable_math.h"
#include "logs/frames/beam_directions.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {

using mrpt::math::TBoundingBox;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kLeastAlone_m = 0.2;
constexpr double kAloneSpacings = 4;

/// Returns the share of a beam's length from which on it reaches farther than both neighbours, with a
/// tolerance of 0.2 m and of four gaps between the beams at its end. So a surface that few beams hit supports
/// its beams unless they graze it. A scan of one beam has no neighbours, and its beam counts as supported.
double alone_from(const std::vector<double>& lengths_m, const std::vector<float>& bearings_rad,
                  std::size_t beam) {
  const std::size_t before = beam > 0 ? beam - 1 : beam + 1;
  const std::size_t after = beam + 1 < lengths_m.size() ? beam + 1 : before;
  if (before >= lengths_m.size()) return 1;
  const double gap_rad = std::abs(static_cast<double>(bearings_rad[before] - bearings_rad[beam]));
  const double length_m = lengths_m[beam];
  const double supported_m =
      std::max(lengths_m[before], lengths_m[after]) + kLeastAlone_m + kAloneSpacings * gap_rad * length_m;
  return supported_m < length_m ? supported_m / length_m : 1;
}

}  // namespace

const std::vector<const Fan*>& RayMaker::fans(const Frame& frame, const TPose2D& map_T_robot) {
  fans_.clear();
  for_each_scan(frame, map_T_robot, [&](const LaserScan& scan, const TPose2D& map_T_robot_then) {
    while (lasers_.size() <= scan.laser) lasers_.emplace_back();
    cast(scan, map_T_robot_then, lasers_[scan.laser]);
    if (frame.is_misplaced) lasers_[scan.laser].rays.clear();
    fans_.push_back(&lasers_[scan.laser]);
  });
  return fans_;
}

void RayMaker::cast(const LaserScan& scan, const TPose2D& map_T_robot, Fan& fan) const {
  fan.bearings = scan.bearings_rad;
  const BeamDirections directions = beam_directions(scan.bearings_rad);
  const std::size_t beams = scan.ranges_m.size();
  if (directions->size() != beams)
    throw std::invalid_argument("draw_grid_map: " + std::to_string(beams) + " ranges but " +
                                std::to_string(directions->size()) + " bearings, expected equal numbers");
  const TPose2D map_T_laser = compose(map_T_robot, scan.robot_T_laser);
  if (!std::isfinite(map_T_laser.x) || !std::isfinite(map_T_laser.y) || !std::isfinite(map_T_laser.phi))
    throw std::invalid_argument("draw_grid_map: the pose of a laser is not finite");
  const double c = portable::cos(map_T_laser.phi);
  const double s = portable::sin(map_T_laser.phi);
  const double clear_m = std::min(options_.no_return_clears_m, static_cast<double>(scan.max_range_m));
  fan.start = {map_T_laser.x, map_T_laser.y};
  fan.rays.clear();
  fan.lengths_m.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const double range_m = static_cast<double>(scan.ranges_m[i]);
    fan.lengths_m[i] =
        std::isnan(range_m) ? 0 : std::min(std::isinf(range_m) ? clear_m : range_m, options_.max_range_m);
  }
  for (std::size_t i = 0; i < beams; ++i) {
    const double range_m = static_cast<double>(scan.ranges_m[i]);
    if (std::isnan(range_m)) continue;
    const double length = fan.lengths_m[i];
    const TPoint2D& direction = (*directions)[i];
    fan.rays.push_back({{fan.start.x + length * (c * direction.x - s * direction.y),
                         fan.start.y + length * (s * direction.x + c * direction.y)},
                        range_m <= options_.max_range_m,
                        std::isfinite(range_m),
                        options_.min_beams > 1 ? alone_from(fan.lengths_m, *fan.bearings, i) : 1});
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
