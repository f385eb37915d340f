// SPDX-License-Identifier: BSD-3-Clause
#include "local_maps/scan_filter.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "frames/pose_operations.h"
#include "frames/scan_neighbours.h"
#include "local_maps/seen_surfaces.h"
#include "local_maps/surface_normals.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Directions of a laser's beams in the robot's frame. A log of one laser shares its bearings among all
/// scans, which then have the directions of the scan before.
class BeamDirections {
 public:
  const std::vector<mrpt::math::TPoint2D>& of(const LaserScan& scan, double laser_yaw_rad) {
    if (bearings_rad_ == scan.bearings_rad && laser_yaw_rad_ == laser_yaw_rad) return directions_;
    bearings_rad_ = scan.bearings_rad;
    laser_yaw_rad_ = laser_yaw_rad;
    directions_.clear();
    for (const float bearing_rad : *scan.bearings_rad) {
      const double bearing = static_cast<double>(bearing_rad) + laser_yaw_rad;
      directions_.emplace_back(portable::cos(bearing), portable::sin(bearing));
    }
    return directions_;
  }

 private:
  std::shared_ptr<const std::vector<float>> bearings_rad_;
  double laser_yaw_rad_ = 0;
  std::vector<mrpt::math::TPoint2D> directions_;
};

ScanPoints points_seen_from(const TPose2D& robot_T_laser, const LaserScan& scan,
                            const ScanFilterOptions& options) {
  ScanPoints result;
  result.origin = {static_cast<float>(robot_T_laser.x), static_cast<float>(robot_T_laser.y)};
  result.points.reserve(scan.ranges_m.size());
  const double spacing_squared = options.spacing_m * options.spacing_m;
  double last_x = 0;
  double last_y = 0;
  double farthest_squared = 0;
  thread_local BeamDirections beams;
  const std::vector<mrpt::math::TPoint2D>& directions = beams.of(scan, robot_T_laser.phi);
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range = static_cast<double>(scan.ranges_m[i]);
    // Also skips beams without a return, whose range is infinite or NaN.
    if (!(range >= options.min_range_m && range <= options.max_range_m)) continue;
    const double x = robot_T_laser.x + range * directions[i].x;
    const double y = robot_T_laser.y + range * directions[i].y;
    const double gap_squared = (x - last_x) * (x - last_x) + (y - last_y) * (y - last_y);
    if (!result.points.empty() && gap_squared < spacing_squared) continue;
    last_x = x;
    last_y = y;
    farthest_squared = std::max(farthest_squared, x * x + y * y);
    result.points.emplace_back(static_cast<float>(x), static_cast<float>(y));
  }
  const bool is_ring = !scan.ranges_m.empty() && is_full_circle(*scan.bearings_rad);
  result.points.shrink_to_fit();  // nodes keep these points
  result.normals.reserve(result.points.size());
  for (std::size_t i = 0; i < result.points.size(); ++i)
    result.normals.push_back(surface_normal(result.points, i, is_ring));
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
  const std::vector<bool> joined =
      ends_on_one_surface(scan, options.max_range_m, options.min_surface_spacing_m);
  const auto is_drawn = [&](float range_m) {
    return static_cast<double>(range_m) >= options.min_range_m && std::isfinite(range_m);
  };
  bool drew_last = !scan.ranges_m.empty() && is_drawn(scan.ranges_m.back());  // before the first beam
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range = static_cast<double>(scan.ranges_m[i]);
    const bool drew_before = std::exchange(drew_last, is_drawn(scan.ranges_m[i]));
    if (!drew_last) continue;
    const double drawn = std::min(range, options.max_range_m);
    const double bearing = static_cast<double>((*scan.bearings_rad)[i]) + map_T_laser.phi;
    beams.ends.emplace_back(map_T_laser.x + drawn * portable::cos(bearing),
                            map_T_laser.y + drawn * portable::sin(bearing));
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
