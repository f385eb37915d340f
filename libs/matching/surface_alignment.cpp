// SPDX-License-Identifier: BSD-3-Clause
#include "matching/surface_alignment.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Point = mrpt::math::TPoint2Df;

class Turned {
 public:
  explicit Turned(double phi)
      : c_(static_cast<float>(portable::cos(phi))), s_(static_cast<float>(portable::sin(phi))) {}
  Point operator()(const Point& p) const { return {c_ * p.x - s_ * p.y, s_ * p.x + c_ * p.y}; }

 private:
  float c_, s_;
};

// Size of the cells in which the surface points are sorted. Affects the speed only, which is best near this
// size with the default max_distance_m.
constexpr double kCell_m = 0.07;

PointGrid placed_points(const std::vector<SurfaceMap::Part>& parts) {
  std::vector<Point> placed;
  for (const SurfaceMap::Part& part : parts) {
    const Turned turned(part.map_T_robot.phi);
    for (const Point& point : part.points->points)
      placed.push_back(turned(point) +
                       Point(static_cast<float>(part.map_T_robot.x), static_cast<float>(part.map_T_robot.y)));
  }
  return PointGrid(std::move(placed), kCell_m);
}

float dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y;
}

/// Mean point and mean normal of the surface points near a point.
struct Surface {
  Point point;
  Point normal;  // unit vector
};

class SurfaceSearch {
 public:
  SurfaceSearch(const SurfaceMap& map, const SurfaceAlignmentOptions& options)
      : map_(map),
        options_(options),
        least_cosine_(static_cast<float>(portable::cos(options.max_turn_rad))) {}

  /// Averages the surface points near `at` whose normals agree with `facing`. Returns nothing if there are
  /// none.
  std::optional<Surface> near(const Point& at, const Point& facing) {
    map_.index().nearest(at, options_.neighbours, static_cast<float>(options_.max_distance_m), found_);
    Surface sum{{0, 0}, {0, 0}};
    float count = 0;
    for (const std::uint32_t k : found_) {
      if (dot(map_.normals()[k], facing) < least_cosine_) continue;
      sum.point += map_.index().points()[k];
      sum.normal += map_.normals()[k];
      ++count;
    }
    if (count == 0) return std::nullopt;
    // The sum is not 0, because all normals agree with `facing`.
    const float length = portable::hypot(sum.normal.x, sum.normal.y);
    return Surface{{sum.point.x / count, sum.point.y / count},
                   {sum.normal.x / length, sum.normal.y / length}};
  }

 private:
  const SurfaceMap& map_;
  const SurfaceAlignmentOptions& options_;
  float least_cosine_;
  std::vector<std::uint32_t> found_;
};

/// A point of the scan near a surface.
struct Contact {
  std::size_t point = 0;  ///< index in the scan
  Surface surface;
};

std::vector<Contact> find_contacts(const SurfaceMap& map, const SurfacePoints& scan, const TPose2D& pose,
                                   const SurfaceAlignmentOptions& options) {
  std::vector<Contact> found;
  found.reserve(scan.points.size());
  const Turned turned(pose.phi);
  const Point position(static_cast<float>(pose.x), static_cast<float>(pose.y));
  SurfaceSearch search(map, options);
  for (std::size_t j = 0; j < scan.points.size(); ++j)
    if (const auto surface = search.near(turned(scan.points[j]) + position, turned(scan.normals[j])))
      found.push_back({j, *surface});
  return found;
}

/// Normal equations of the scan without the prior, for points with unit variance.
struct Normals {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d descent = Eigen::Vector3d::Zero();
  double weights = 0;
  double weighted_squares = 0;

  double variance() const { return weighted_squares / weights; }
};

Normals compare(const std::vector<Contact>& contacts, const SurfacePoints& scan, const TPose2D& pose,
                const SurfaceAlignmentOptions& options) {
  Normals normals;
  const Turned turned(pose.phi);
  const Point position(static_cast<float>(pose.x), static_cast<float>(pose.y));
  for (const Contact& contact : contacts) {
    const Point arm = turned(scan.points[contact.point]);
    const Point& normal = contact.surface.normal;
    const auto residual = static_cast<double>(dot(normal, arm + position - contact.surface.point));
    const double shrink = 1 + residual * residual / (options.kernel_m * options.kernel_m);
    const double weight = 1 / (shrink * shrink);
    const Eigen::Vector3d slope(static_cast<double>(normal.x), static_cast<double>(normal.y),
                                static_cast<double>(arm.x * normal.y - arm.y * normal.x));
    normals.hessian.noalias() += weight * slope * slope.transpose();
    normals.descent -= weight * residual * slope;
    normals.weights += weight;
    normals.weighted_squares += weight * residual * residual;
  }
  return normals;
}

/// Distance of the farthest point from the robot.
double reach(const SurfacePoints& scan) {
  float squared = 0;
  for (const Point& point : scan.points) squared = std::max(squared, dot(point, point));
  return std::sqrt(static_cast<double>(squared));
}

/// Returns how far at most a point of the scan moves between two poses.
double largest_move(const TPose2D& from, const TPose2D& to, double reach_m) {
  return portable::hypot(to.x - from.x, to.y - from.y) +
         reach_m * std::abs(mrpt::math::wrapToPi(to.phi - from.phi));
}

}  // namespace

SurfacePoints surface_points(const ScanPoints& scan) {
  SurfacePoints result;
  if (scan.normals.empty()) return result;
  for_each_laser(scan, [&](const Point& origin, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const Point& normal = scan.normals[i];
      if (normal.x == 0.0F && normal.y == 0.0F) continue;
      result.points.push_back(scan.points[i]);
      const bool away = dot(normal, scan.points[i] - origin) > 0;
      result.normals.push_back(away ? Point(-normal.x, -normal.y) : normal);
    }
  });
  return result;
}

SurfaceMap::SurfaceMap(const std::vector<Part>& parts) : index_(placed_points(parts)) {
  normals_.reserve(index_.points().size());
  for (const Part& part : parts) {
    const Turned turned(part.map_T_robot.phi);
    for (const Point& normal : part.points->normals) normals_.push_back(turned(normal));
  }
}

SurfaceAlignment align_to_surfaces(const SurfaceMap& map, const SurfacePoints& scan, const TPose2D& start,
                                   const TPose2D& held_at, const SurfaceAlignmentOptions& options) {
  const Eigen::Vector3d prior(1 / (options.prior_sigma_m * options.prior_sigma_m),
                              1 / (options.prior_sigma_m * options.prior_sigma_m),
                              1 / (options.prior_sigma_rad * options.prior_sigma_rad));
  const double reach_m = reach(scan);
  SurfaceAlignment result{start, 0};
  TPose2D& pose = result.map_T_robot;
  TPose2D searched_at = start;
  std::vector<Contact> near = find_contacts(map, scan, start, options);
  for (int i = 0; i < options.iterations; ++i) {
    if (largest_move(searched_at, pose, reach_m) > options.search_again_m) {
      near = find_contacts(map, scan, pose, options);
      searched_at = pose;
    }
    result.points = near.size();
    if (near.size() < options.min_points) return {start, near.size()};
    const Normals scan_alone = compare(near, scan, pose, options);
    const Eigen::Vector3d held = scan_alone.variance() * prior;
    Eigen::Matrix3d hessian = scan_alone.hessian;
    hessian.diagonal() += held;
    const Eigen::Vector3d off(held_at.x - pose.x, held_at.y - pose.y,
                              mrpt::math::wrapToPi(held_at.phi - pose.phi));
    const Eigen::Vector3d step = hessian.ldlt().solve(scan_alone.descent + held.cwiseProduct(off));
    if (!step.allFinite()) return {start, near.size()};
    pose = TPose2D(pose.x + step.x(), pose.y + step.y(), mrpt::math::wrapToPi(pose.phi + step.z()));
  }
  return result;
}

}  // namespace psi_slam
