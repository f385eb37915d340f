// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/surface_normals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/scan_neighbours.h"

namespace psi_slam {
namespace {

using Point = mrpt::math::TPoint2Df;

constexpr std::ptrdiff_t kReach = 3;        // largest number of neighbours on each side used to fit a line
constexpr std::ptrdiff_t kLeastPoints = 4;  // least number of points on a surface, with the point itself
constexpr float kMaxSurfaceGap_m = 0.4F;    // largest gap between neighbours on one surface
constexpr float kMaxGapPerMetre = 0.15F;    // the same limit per metre of range; the larger limit applies
constexpr float kMaxResidual_m = 0.04F;     // largest root mean square distance of points from their line

// Whether a surface continues from each point to the next one, and to the previous one.
struct Joints {
  std::vector<std::uint8_t> to_next;
  std::vector<std::uint8_t> to_previous;
};

Joints joints_of(const std::vector<Point>& points) {
  const std::size_t size = points.size();
  std::vector<float> max_gaps(size);
  std::transform(points.begin(), points.end(), max_gaps.begin(), [](const Point& point) {
    return std::max(kMaxSurfaceGap_m, kMaxGapPerMetre * portable::hypot(point.x, point.y));
  });
  Joints joints{std::vector<std::uint8_t>(size), std::vector<std::uint8_t>(size)};
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t next = index_on_ring(static_cast<std::ptrdiff_t>(i) + 1, size);
    const float gap = distance_m(points[next], points[i]);
    joints.to_next[i] = gap <= max_gaps[i] ? 1 : 0;
    joints.to_previous[next] = gap <= max_gaps[next] ? 1 : 0;
  }
  return joints;
}

// Returns the unit vector along which points spread least, from the sums over their offsets (x, y) from the
// mean: `half_difference` = Σ(x² − y²)/2 and `xy` = Σxy. Points spread most at the angle atan2(xy,
// half_difference)/2. The half-angle formulas need square roots only, which are the same on every processor.
Point direction_of_least_spread(double half_difference, double xy) {
  const double root = std::sqrt(half_difference * half_difference + xy * xy);
  if (root == 0) return {0, 1};
  double cosine = 0;
  double sine = 0;
  if (half_difference >= 0) {
    cosine = std::sqrt(0.5 + 0.5 * half_difference / root);
    sine = xy / (2 * root * cosine);
  } else {
    sine = std::copysign(std::sqrt(0.5 - 0.5 * half_difference / root), xy);
    cosine = xy / (2 * root * sine);
  }
  return {static_cast<float>(-sine), static_cast<float>(cosine)};
}

// Sums over the offsets of points from their mean, for the line through the points.
struct Spread {
  float xx = 0;
  float xy = 0;
  float yy = 0;

  float half_difference() const { return 0.5F * (xx - yy); }
  float smaller() const { return 0.5F * (xx + yy) - portable::hypot(half_difference(), xy); }
};

// Returns the unit normal of the line through the neighbours of a point, and through the point itself if
// `with_point`.
Point normal_of_line(const std::vector<Point>& points, const Joints& joints, std::size_t index, bool is_ring,
                     bool with_point) {
  const auto goes_on = [&](std::size_t from, std::size_t to) {
    const bool is_next = to == index_on_ring(static_cast<std::ptrdiff_t>(from) + 1, points.size());
    return (is_next ? joints.to_next : joints.to_previous)[from] != 0;
  };
  const Neighbourhood near = neighbourhood(index, points.size(), kReach, is_ring, goes_on);
  if (near.count() < kLeastPoints) return {0, 0};
  const auto at = [&](std::ptrdiff_t k) -> const Point& { return points[index_on_ring(k, points.size())]; };
  const auto is_used = [&](std::ptrdiff_t k) {
    return with_point || k != static_cast<std::ptrdiff_t>(index);
  };
  const auto count = static_cast<float>(near.count() - (with_point ? 0 : 1));
  float mean_x = 0;
  float mean_y = 0;
  for (std::ptrdiff_t k = near.first; k <= near.last; ++k)
    if (is_used(k)) mean_x += at(k).x, mean_y += at(k).y;
  mean_x /= count;
  mean_y /= count;
  Spread spread;
  for (std::ptrdiff_t k = near.first; k <= near.last; ++k) {
    if (!is_used(k)) continue;
    const float dx = at(k).x - mean_x;
    const float dy = at(k).y - mean_y;
    spread.xx += dx * dx;
    spread.xy += dx * dy;
    spread.yy += dy * dy;
  }
  if (spread.smaller() > count * kMaxResidual_m * kMaxResidual_m) return {0, 0};
  return direction_of_least_spread(static_cast<double>(spread.half_difference()),
                                   static_cast<double>(spread.xy));
}

std::vector<Point> normals_of_lines(const std::vector<Point>& points, bool is_ring, bool with_point) {
  const Joints joints = joints_of(points);
  std::vector<Point> normals;
  normals.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    normals.push_back(normal_of_line(points, joints, i, is_ring, with_point));
  return normals;
}

}  // namespace

std::vector<Point> surface_normals(const std::vector<Point>& points, bool is_ring) {
  return normals_of_lines(points, is_ring, true);
}

std::vector<Point> normals_of_neighbours(const std::vector<Point>& points) {
  return normals_of_lines(points, false, false);
}

}  // namespace psi_slam
