// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/local_maps/scan_filter.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {

ScanPoints matching_points(const LaserScan& scan, const ScanFilterOptions& options) {
  ScanPoints result;
  result.origin = {static_cast<float>(scan.robot_T_laser.x), static_cast<float>(scan.robot_T_laser.y)};
  result.points.reserve(scan.ranges_m.size());
  const double spacing_squared = options.spacing_m * options.spacing_m;
  double last_x = 0;
  double last_y = 0;
  double farthest_squared = 0;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range = static_cast<double>(scan.ranges_m[i]);
    if (!(range >= options.min_range_m && range <= options.max_range_m)) continue;  // NaN too
    const double bearing = static_cast<double>((*scan.bearings_rad)[i]) + scan.robot_T_laser.phi;
    const double x = scan.robot_T_laser.x + range * std::cos(bearing);
    const double y = scan.robot_T_laser.y + range * std::sin(bearing);
    const double gap_squared = (x - last_x) * (x - last_x) + (y - last_y) * (y - last_y);
    if (!result.points.empty() && gap_squared < spacing_squared) continue;
    last_x = x;
    last_y = y;
    farthest_squared = std::max(farthest_squared, x * x + y * y);
    result.points.emplace_back(static_cast<float>(x), static_cast<float>(y));
  }
  result.farthest_m = std::sqrt(farthest_squared);
  return result;
}

Beams drawing_beams(const LaserScan& scan, const mrpt::math::TPose2D& map_T_robot, double min_range_m,
                    double max_range_m) {
  Beams beams;
  const mrpt::math::TPose2D map_T_laser = map_T_robot + scan.robot_T_laser;
  beams.origin = {map_T_laser.x, map_T_laser.y};
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range = static_cast<double>(scan.ranges_m[i]);
    if (!(range >= min_range_m)) continue;
    const double drawn = std::min(range, max_range_m);
    const double bearing = static_cast<double>((*scan.bearings_rad)[i]) + map_T_laser.phi;
    beams.ends.emplace_back(map_T_laser.x + drawn * std::cos(bearing),
                            map_T_laser.y + drawn * std::sin(bearing));
    beams.hits.push_back(range <= max_range_m);
  }
  return beams;
}

}  // namespace psi_slam
