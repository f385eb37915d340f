// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/scan_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "logs/frames/beam_directions.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/scan_neighbours.h"
#include "mapping/local_maps/seen_surfaces.h"
#include "mapping/local_maps/surface_normals.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

ScanPoints points_seen_from(const TPose2D& robot_T_laser, const LaserScan& scan,
                            const ScanFilterOptions& options) {
  ScanPoints result;
  result.origin = {static_cast<float>(robot_T_laser.x), static_cast<float>(robot_T_laser.y)};
  result.points.reserve(scan.ranges_m.size());
  const double spacing_squared = options.spacing_m * options.spacing_m;
  double last_x = 0;
  double last_y = 0;
  double farthest_squared = 0;
  const double c = portable::cos(robot_T_laser.phi);
  const double s = portable::sin(robot_T_laser.phi);
  const BeamDirections directions = beam_directions(scan.bearings_rad);
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range = static_cast<double>(scan.ranges_m[i]);
    // Also skips beams without a return, whose range is infinite or NaN.
    if (!(range > 0 && range <= options.max_range_m)) continue;
    const mrpt::math::TPoint2D& direction = (*directions)[i];
    const double x = robot_T_laser.x + range * (c * direction.x - s * direction.y);
    const double y = robot_T_laser.y + range * (s * direction.x + c * direction.y);
    const double gap_squared = (x - last_x) * (x - last_x) + (y - last_y) * (y - last_y);
    if (!result.points.empty() && gap_squared < spacing_squared) continue;
    last_x = x;
    last_y = y;
    farthest_squared = std::max(farthest_squared, x * x + y * y);
    result.points.emplace_back(static_cast<float>(x), static_cast<float>(y));
  }
  const bool is_ring = !scan.ranges_m.empty() && is_full_circle(*scan.bearings_rad);
  result.points.shrink_to_fit();  // nodes keep these points
  result.normals = surface_normals(result.points, is_ring);
  result.farthest_m = std::sqrt(farthest_squared);
  return result;
}

}  // namespace

ScanPoints matching_points(const LaserScan& scan, const ScanFilterOptions& options) {
  return points_seen_from(scan.robot_T_laser, scan, options);
}

ScanPoints matching_points(const Frame& frame, const ScanFilterOptions& options) {
  ScanPoints all = matching_points(frame.scan, options);
  for (const CompanionScan& companion : frame.companions) {
    const ScanPoints one = points_seen_from(compose(companion.frame_T_robot, companion.scan.robot_T_laser),
                                            companion.scan, options);
    all.other_lasers.push_back({all.points.size(), one.origin});
    all.points.insert(all.points.end(), one.points.begin(), one.points.end());
    all.normals.insert(all.normals.end(), one.normals.begin(), one.normals.end());
    all.farthest_m = std::max(all.farthest_m, one.farthest_m);
  }
  return all;
}

Beams drawing_beams(const LaserScan& scan, const TPose2D& map_T_robot, const DrawingOptions& options) {
  Beams beams;
  const TPose2D map_T_laser = compose(map_T_robot, scan.robot_T_laser);
  beams.origin = {map_T_laser.x, map_T_laser.y};
  beams.ends.reserve(scan.ranges_m.size());
  const double c = portable::cos(map_T_laser.phi);
  const double s = portable::sin(map_T_laser.phi);
  const BeamDirections directions = beam_directions(scan.bearings_rad);
  const std::vector<bool> joined =
      ends_on_one_surface(scan, options.max_range_m, options.min_surface_spacing_m);
  const auto is_drawn = [&](float range_m) { return range_m > 0 && std::isfinite(range_m); };
  bool drew_last = !scan.ranges_m.empty() && is_drawn(scan.ranges_m.back());  // before the first beam
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range = static_cast<double>(scan.ranges_m[i]);
    const bool drew_before = std::exchange(drew_last, is_drawn(scan.ranges_m[i]));
    if (!drew_last) continue;
    const double drawn = std::min(range, options.max_range_m);
    const mrpt::math::TPoint2D& direction = (*directions)[i];
    beams.ends.emplace_back(map_T_laser.x + drawn * (c * direction.x - s * direction.y),
                            map_T_laser.y + drawn * (s * direction.x + c * direction.y));
    beams.hits.push_back(range <= options.max_range_m);
    beams.joined.push_back(drew_before && joined[i]);
  }
  return beams;
}

std::vector<Beams> drawing_beams(const Frame& frame, const TPose2D& map_T_robot,
                                 const DrawingOptions& options) {
  std::vector<Beams> beams;
  for_each_scan(frame, map_T_robot, [&](const LaserScan& scan, const TPose2D& map_T_robot_then) {
    beams.push_back(drawing_beams(scan, map_T_robot_then, options));
  });
  return beams;
}

}  // namespace psi_slam
