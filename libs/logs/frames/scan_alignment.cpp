// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/scan_alignment.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/scan_neighbours.h"

namespace psi_slam {
namespace {

using Point = AlignableScan::Point;

constexpr double kFirstRadius_m = 0.6;  // first radius of the search for the wall near a point
constexpr double kLastRadius_m = 0.15;
constexpr int kIterations = 25;
constexpr double kHuber_m = 0.03;
constexpr double kLeastNoise_m = 0.01;  // least noise of ranges: a perfect fit keeps a realistic covariance
constexpr double kDamping_m = 1e-4;  // damping per matched point; holds the guess in directions without walls
constexpr std::size_t kFewestMatches = 20;
constexpr std::ptrdiff_t kNeighbours = 2;  // points on either side that define the normal of a point's wall

/// Returns whether two neighbouring beams hit one surface. The limit of the distance between their points is
/// the distance on a surface whose normal is 75 degrees from the beams, plus 5 cm.
bool on_one_surface(const Point& a, const Point& b) {
  const double range = std::min(a.position_m.norm(), b.position_m.norm());
  const double spacing = range * std::abs(std::remainder(b.bearing_rad - a.bearing_rad, 2 * M_PI));
  return (a.position_m - b.position_m).norm() < 4 * spacing + 0.05;
}

/// Normal of the wall at a point. `is_ring`: the last point and the first are neighbours.
Eigen::Vector2d normal_at(const std::vector<Point>& points, std::size_t i, bool is_ring) {
  const Neighbourhood near =
      neighbourhood(i, points.size(), kNeighbours, is_ring,
                    [&](std::size_t a, std::size_t b) { return on_one_surface(points[a], points[b]); });
  const auto at = [&](std::ptrdiff_t k) -> const Point& { return points[index_on_ring(k, points.size())]; };
  const auto count = static_cast<double>(near.count());
  if (count < 3) return Eigen::Vector2d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::ptrdiff_t k = near.first; k <= near.last; ++k) mean += at(k).position_m / count;
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (std::ptrdiff_t k = near.first; k <= near.last; ++k) {
    const Eigen::Vector2d d = at(k).position_m - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double along = 0.5 * portable::atan2(2 * xy, xx - yy);  // direction in which the points spread most
  return {-portable::sin(along), portable::cos(along)};
}

struct Match {
  Eigen::Vector2d point;  // point of the scan, in the frame of the reference's laser
  double distance = 0;    // signed distance to the wall, metres
  const Point* wall = nullptr;
};

/// Returns the nearest point of the reference within a radius. Returns null if there is no such point or if
/// it has no normal. A point at range r is at least r sin(d) away from beams at an angle d, which limits the
/// beams to search: first by the radius, then by the distance of the nearest point found. `bearing_rad`
/// is that of `p`.
const Point* nearest_wall(const AlignableScan& reference, const Eigen::Vector2d& p, double bearing_rad,
                          double radius_m) {
  const std::vector<Point>& walls = reference.points();
  const auto size = static_cast<std::ptrdiff_t>(walls.size());
  const double range = p.norm();
  // An upper bound of the arc sine, which is cheaper to compute. All terms of its series are positive, and
  // those after the first add up to pi/2 - 1 at 1.
  const auto reach = [&](double distance_m) {
    const double sine = distance_m / range;
    return sine < 1 ? sine + (M_PI / 2 - 1) * sine * sine * sine : M_PI;
  };
  const auto comes_before = [](const Point& point, double value) { return point.bearing_rad < value; };
  const auto start = std::lower_bound(walls.begin(), walls.end(), bearing_rad, comes_before) - walls.begin();
  const Point* nearest = nullptr;
  double nearest_squared = radius_m * radius_m;
  double limit_rad = reach(radius_m);
  // Compares with point `k`, which may be up to one round away. Returns false beyond the limit.
  const auto compare_with = [&](std::ptrdiff_t k) {
    const bool is_beyond_an_end = k < 0 || k >= size;
    if (is_beyond_an_end && !reference.is_full_circle()) return false;
    const Point& wall = walls[index_on_ring(k, walls.size())];
    const double round = is_beyond_an_end ? (k < 0 ? -2 * M_PI : 2 * M_PI) : 0;
    if (std::abs(wall.bearing_rad + round - bearing_rad) > limit_rad) return false;
    const double squared = (wall.position_m - p).squaredNorm();
    if (squared >= nearest_squared) return true;
    nearest = &wall;
    nearest_squared = squared;
    limit_rad = reach(std::sqrt(squared));
    return true;
  };
  for (std::ptrdiff_t k = start; k < start + size && compare_with(k); ++k) continue;
  for (std::ptrdiff_t k = start - 1; k >= start - size && compare_with(k); --k) continue;
  return nearest != nullptr && nearest->normal != Eigen::Vector2d::Zero() ? nearest : nullptr;
}

struct Matching {
  std::vector<Match> matches;
  std::size_t visible = 0;  // points within the field of view of the reference
};

Matching match_points(const AlignableScan& reference, const AlignableScan& scan,
                      const mrpt::math::TPose2D& reference_T_scan, double radius_m) {
  Matching matching;
  const std::vector<Point>& walls = reference.points();
  if (walls.empty()) return matching;
  const double c = portable::cos(reference_T_scan.phi);
  const double s = portable::sin(reference_T_scan.phi);
  matching.matches.reserve(scan.points().size());
  for (const Point& point : scan.points()) {
    const Eigen::Vector2d p{reference_T_scan.x + c * point.position_m.x() - s * point.position_m.y(),
                            reference_T_scan.y + s * point.position_m.x() + c * point.position_m.y()};
    const double bearing = reference.bearing_rad(p);
    const bool is_visible = reference.is_full_circle() ||
                            (bearing >= walls.front().bearing_rad && bearing <= walls.back().bearing_rad);
    if (!is_visible) continue;
    ++matching.visible;
    const Point* wall = nearest_wall(reference, p, bearing, radius_m);
    if (wall != nullptr) matching.matches.push_back({p, wall->normal.dot(p - wall->position_m), wall});
  }
  return matching;
}

struct NormalEquations {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// Normal equations of increments (dx, dy, dheading) that turn about the scan's position in the reference.
NormalEquations normal_equations(const std::vector<Match>& matches,
                                 const mrpt::math::TPose2D& reference_T_scan) {
  NormalEquations equations;
  const Eigen::Vector2d centre{reference_T_scan.x, reference_T_scan.y};
  for (const Match& match : matches) {
    const Eigen::Vector2d arm = match.point - centre;
    const Eigen::Vector2d normal = match.wall->normal;
    const Eigen::Vector3d jacobian{normal.x(), normal.y(), normal.y() * arm.x() - normal.x() * arm.y()};
    const double weight = std::min(1.0, kHuber_m / std::max(std::abs(match.distance), 1e-12));
    equations.hessian += weight * jacobian * jacobian.transpose();
    equations.gradient += weight * match.distance * jacobian;
  }
  return equations;
}

void rate(const Matching& matching, double radius_m, const mrpt::math::TPose2D& laser_pose,
          ScanAlignment& result) {
  double sum = 0;
  for (const Match& match : matching.matches) sum += std::min(std::abs(match.distance), radius_m);
  const auto matched = static_cast<double>(matching.matches.size());
  const auto visible = static_cast<double>(matching.visible);
  result.residual_m = matched > 0 ? sum / matched : radius_m;
  result.cost_m = visible > 0 ? (sum + (visible - matched) * radius_m) / visible : radius_m;
  result.matched_share = visible > 0 ? matched / visible : 0;
  // Standard deviation of the ranges, estimated from the mean distance to walls.
  const double noise = std::max(kLeastNoise_m, 1.25 * result.residual_m);
  Eigen::Matrix3d information = normal_equations(matching.matches, laser_pose).hessian;
  information.diagonal().array() += 1e-6;
  result.covariance = noise * noise * information.inverse();
}

}  // namespace

AlignableScan::AlignableScan(const LaserScan& scan, double max_range_m, std::size_t max_points)
    : robot_T_laser_(scan.robot_T_laser) {
  const std::size_t beams = scan.ranges_m.size();
  if (beams == 0) return;
  const std::size_t step = std::max<std::size_t>(1, (beams + max_points - 1) / max_points);
  points_.reserve(beams / step + 1);
  const std::vector<float>& bearings_rad = *scan.bearings_rad;
  const auto [least, most] = std::minmax_element(bearings_rad.begin(), bearings_rad.end());
  middle_bearing_rad_ = (static_cast<double>(*least) + static_cast<double>(*most)) / 2;
  for (std::size_t i = 0; i < beams; i += step) {
    const auto range = static_cast<double>(scan.ranges_m[i]);
    const double bearing = near_middle(static_cast<double>(bearings_rad[i]));
    if (!(range <= max_range_m)) continue;  // also skips beams without return
    points_.push_back({range * Eigen::Vector2d(portable::cos(bearing), portable::sin(bearing)),
                       Eigen::Vector2d::Zero(), bearing});
  }
  std::sort(points_.begin(), points_.end(),
            [](const Point& a, const Point& b) { return a.bearing_rad < b.bearing_rad; });
  is_full_circle_ = psi_slam::is_full_circle(bearings_rad);
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i].normal = normal_at(points_, i, is_full_circle_);
}

double AlignableScan::near_middle(double bearing_rad) const {
  while (bearing_rad > middle_bearing_rad_ + M_PI) bearing_rad -= 2 * M_PI;
  while (bearing_rad < middle_bearing_rad_ - M_PI) bearing_rad += 2 * M_PI;
  return bearing_rad;
}

double AlignableScan::bearing_rad(const Eigen::Vector2d& position_m) const {
  return near_middle(portable::atan2(position_m.y(), position_m.x()));
}

double ScanAlignment::deviation_along_m(double heading_rad) const {
  const Eigen::Vector2d direction{portable::cos(heading_rad), portable::sin(heading_rad)};
  return std::sqrt(direction.dot(covariance.topLeftCorner<2, 2>() * direction));
}

double ScanAlignment::heading_deviation_rad() const {
  return std::sqrt(covariance(2, 2));
}

ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const mrpt::math::TPose2D& guess) {
  // Pose of the scan's laser relative to the reference's laser; converted to a pose of the robot at the end.
  mrpt::math::TPose2D pose = between(reference.robot_T_laser(), compose(guess, scan.robot_T_laser()));
  double radius_m = kFirstRadius_m;
  for (int i = 0; i < kIterations; ++i) {
    const Matching matching = match_points(reference, scan, pose, radius_m);
    if (matching.matches.size() < kFewestMatches) break;
    NormalEquations equations = normal_equations(matching.matches, pose);
    const double damping = kDamping_m * static_cast<double>(matching.matches.size());
    equations.hessian.diagonal().array() += damping;
    const Eigen::Vector3d step = -equations.hessian.ldlt().solve(equations.gradient);
    pose.x += step.x();
    pose.y += step.y();
    pose.phi = mrpt::math::wrapToPi(pose.phi + step.z());
    const bool at_rest = step.head<2>().norm() < 1e-4 && std::abs(step.z()) < 1e-5;
    if (at_rest && radius_m <= kLastRadius_m) break;
    radius_m = std::max(kLastRadius_m, at_rest ? radius_m / 2 : radius_m * 0.8);
  }
  ScanAlignment result;
  rate(match_points(reference, scan, pose, kLastRadius_m), kLastRadius_m, pose, result);
  const mrpt::math::TPose2D laser_T_robot = inverse(scan.robot_T_laser());
  result.reference_T_scan = compose(compose(reference.robot_T_laser(), pose), laser_T_robot);
  return result;
}

ScanAlignment align_scans(const AlignableScan& reference, const AlignableScan& scan,
                          const std::vector<mrpt::math::TPose2D>& guesses) {
  ScanAlignment best;
  best.cost_m = std::numeric_limits<double>::infinity();
  for (const mrpt::math::TPose2D& guess : guesses) {
    ScanAlignment alignment = align_scans(reference, scan, guess);
    if (alignment.cost_m < best.cost_m) best = alignment;
  }
  return best;
}

}  // namespace psi_slam
