// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/scan_alignment.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "local_maps/scan_filter.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

constexpr double kFirstRadius_m = 0.6;  // of the search for the surface of a point
constexpr double kLastRadius_m = 0.15;
constexpr int kIterations = 25;
constexpr double kHuber_m = 0.03;
constexpr double kLeastNoise_m = 0.01;  // of ranges, so that a perfect fit has a realistic covariance

LaserScan every_nth_beam(const LaserScan& scan, std::size_t step) {
  LaserScan thinned;
  thinned.robot_T_laser = scan.robot_T_laser;
  std::vector<float> bearings_rad;
  for (std::size_t i = 0; i < scan.ranges_m.size(); i += step) {
    thinned.ranges_m.push_back(scan.ranges_m[i]);
    bearings_rad.push_back((*scan.bearings_rad)[i]);
  }
  thinned.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings_rad));
  return thinned;
}

SurfacePoints thinned_surface(const LaserScan& scan, double max_range_m, std::size_t max_points) {
  const std::size_t step = std::max<std::size_t>(1, (scan.ranges_m.size() + max_points - 1) / max_points);
  return surface_points(matching_points(every_nth_beam(scan, step), {0, max_range_m, 0}));
}

/// One step of the alignment with this search radius.
SurfaceAlignmentOptions step_options(double radius_m) {
  SurfaceAlignmentOptions options;
  options.neighbours = 1;
  options.max_distance_m = radius_m;
  options.max_turn_rad = 1.5;
  options.kernel_m = std::max(kHuber_m, radius_m / 2);
  options.prior_sigma_m = 1;  // holds the pose only in directions without surfaces
  options.prior_sigma_rad = 1;
  options.iterations = 1;
  return options;
}

ScanAlignment rated(const AlignableScan& reference, const AlignableScan& scan, const TPose2D& pose) {
  const Eigen::Rotation2Dd rotation(pose.phi);
  const Eigen::Vector2d position(pose.x, pose.y);
  double visible = 0;
  double matched = 0;
  double sum_m = 0;
  Eigen::Matrix3d information = 1e-6 * Eigen::Matrix3d::Identity();
  std::vector<std::size_t> nearest;
  for (const mrpt::math::TPoint2Df& point : scan.surface().points) {
    const Eigen::Vector2d arm = rotation * Eigen::Vector2f(point.x, point.y).cast<double>();
    const Eigen::Vector2d at = position + arm;
    if (!reference.sees(at)) continue;
    ++visible;
    const SurfaceMap& map = reference.map();
    map.index().nearest({static_cast<float>(at.x()), static_cast<float>(at.y())}, 1,
                        static_cast<float>(kLastRadius_m), nearest);
    if (nearest.empty()) continue;
    ++matched;
    const auto& wall = map.index().points()[nearest.front()];
    const auto& wall_normal = map.normals()[nearest.front()];
    const Eigen::Vector2d normal = Eigen::Vector2f(wall_normal.x, wall_normal.y).cast<double>();
    const double distance_m = std::abs(normal.dot(at - Eigen::Vector2f(wall.x, wall.y).cast<double>()));
    sum_m += std::min(distance_m, kLastRadius_m);
    const Eigen::Vector3d slope{normal.x(), normal.y(), normal.y() * arm.x() - normal.x() * arm.y()};
    information += std::min(1.0, kHuber_m / std::max(distance_m, 1e-12)) * slope * slope.transpose();
  }
  ScanAlignment result;
  result.reference_T_scan = pose;
  result.cost_m = visible > 0 ? (sum_m + (visible - matched) * kLastRadius_m) / visible : kLastRadius_m;
  result.matched_share = visible > 0 ? matched / visible : 0;
  const double mean_m = matched > 0 ? sum_m / matched : kLastRadius_m;
  const double noise_m = std::max(kLeastNoise_m, 1.25 * mean_m);  // standard deviation from the mean
  result.covariance = noise_m * noise_m * information.inverse();
  return result;
}

}  // namespace

AlignableScan::AlignableScan(const LaserScan& scan, double max_range_m, std::size_t max_points)
    : surface_(thinned_surface(scan, max_range_m, max_points)),
      map_(std::vector<SurfaceMap::Part>{{&surface_, {0, 0, 0}}}),
      robot_T_laser_(scan.robot_T_laser),
      first_rad_(std::numeric_limits<double>::infinity()),
      last_rad_(-first_rad_) {
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    if (!(static_cast<double>(scan.ranges_m[i]) <= max_range_m)) continue;  // NaN too
    const double bearing_rad = wrapToPi(static_cast<double>((*scan.bearings_rad)[i]));
    first_rad_ = std::min(first_rad_, bearing_rad);
    last_rad_ = std::max(last_rad_, bearing_rad);
  }
}

bool AlignableScan::sees(const Eigen::Vector2d& point_m) const {
  const auto seen = robot_T_laser_.inverseComposePoint({point_m.x(), point_m.y()});
  const double bearing_rad = std::atan2(seen.y, seen.x);
  return bearing_rad >= first_rad_ && bearing_rad <= last_rad_;
}

double ScanAlignment::deviation_along_m(double heading_rad) const {
  const Eigen::Vector2d direction{std::cos(heading_rad), std::sin(heading_rad)};
  return std::sqrt(direction.dot(covariance.topLeftCorner<2, 2>() * direction));
}

double ScanAlignment::heading_deviation_rad() const {
  return std::sqrt(covariance(2, 2));
}

ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan, const TPose2D& guess) {
  TPose2D pose = guess;
  double radius_m = kFirstRadius_m;
  for (int i = 0; i < kIterations; ++i) {
    const TPose2D next =
        align_to_surfaces(reference.map(), scan.surface(), pose, pose, step_options(radius_m)).map_T_robot;
    const bool at_rest =
        std::hypot(next.x - pose.x, next.y - pose.y) < 1e-4 && std::abs(wrapToPi(next.phi - pose.phi)) < 1e-5;
    pose = next;
    if (at_rest && radius_m <= kLastRadius_m) break;
    radius_m = std::max(kLastRadius_m, at_rest ? radius_m / 2 : radius_m * 0.8);
  }
  return rated(reference, scan, pose);
}

ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const std::vector<TPose2D>& guesses) {
  ScanAlignment best;
  best.cost_m = std::numeric_limits<double>::infinity();
  for (const TPose2D& guess : guesses) {
    ScanAlignment alignment = align_scans(reference, scan, guess);
    if (alignment.cost_m < best.cost_m) best = alignment;
  }
  return best;
}

}  // namespace psi_slam
