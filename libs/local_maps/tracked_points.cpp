// SPDX-License-Identifier: BSD-3-Clause
#include "local_maps/tracked_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/portable_math.h"
#include "local_maps/surface_normals.h"

namespace psi_slam {
namespace {

using Point = mrpt::math::TPoint2Df;

constexpr std::size_t kPoints = 4;     // number of points on the line of a grazed wall
constexpr double kMaxOffset_m = 0.04;  // largest distance of a point from the line through the outer points
constexpr double kMaxGapRatio = 16;    // largest ratio of the widest gap between the points to the narrowest

bool is_set(const Point& normal) {
  return normal.x != 0.0F || normal.y != 0.0F;
}

struct Line {
  Point normal;         // unit vector
  double offset_m = 0;  // largest distance of a point from the line
};

double gap_m(const Point& a, const Point& b) {
  return static_cast<double>(portable::hypot(b.x - a.x, b.y - a.y));
}

/// Returns the line through the first and the last of kPoints points. Empty if the points do not lie on it,
/// or are not spread along it.
std::optional<Line> line_through(const Point* points) {
  std::array<double, kPoints - 1> gaps_m{};
  for (std::size_t k = 0; k < gaps_m.size(); ++k) gaps_m[k] = gap_m(points[k], points[k + 1]);
  const auto [narrowest, widest] = std::minmax_element(gaps_m.begin(), gaps_m.end());
  if (*widest > kMaxGapRatio * *narrowest) return {};
  const double length = gap_m(points[0], points[kPoints - 1]);
  if (length < *widest) return {};  // the points turn back
  const double x = static_cast<double>(points[0].y - points[kPoints - 1].y) / length;
  const double y = static_cast<double>(points[kPoints - 1].x - points[0].x) / length;
  Line line{{static_cast<float>(x), static_cast<float>(y)}, 0};
  for (std::size_t k = 1; k + 1 < kPoints; ++k) {
    const double offset = std::abs(x * static_cast<double>(points[k].x - points[0].x) +
                                   y * static_cast<double>(points[k].y - points[0].y));
    line.offset_m = std::max(line.offset_m, offset);
  }
  if (line.offset_m > kMaxOffset_m) return {};
  return line;
}

/// Normals of the points of one laser. A point without a normal gets that of the straightest line through it.
std::vector<Point> normals_along_walls(const std::vector<Point>& points, const std::vector<Point>& normals) {
  std::vector<std::optional<Line>> lines;  // by their first point
  for (std::size_t i = 0; i + kPoints <= points.size(); ++i) lines.push_back(line_through(&points[i]));
  std::vector<Point> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_set(normals[i])) {
      result.push_back(normal_of_neighbours(points, i));
      continue;
    }
    const Line* straightest = nullptr;
    for (std::size_t k = i < kPoints ? 0 : i - (kPoints - 1); k <= i && k < lines.size(); ++k)
      if (lines[k] && (straightest == nullptr || lines[k]->offset_m < straightest->offset_m))
        straightest = &*lines[k];
    result.push_back(straightest == nullptr ? Point(0, 0) : straightest->normal);
  }
  return result;
}

}  // namespace

TrackedPoints points_along_walls(const ScanPoints& scan) {
  TrackedPoints tracked{scan, {}};
  if (scan.normals.empty()) return tracked;
  for_each_laser(scan, [&](const Point&, std::size_t first, std::size_t end) {
    const auto slice = [&](const std::vector<Point>& all) {
      return std::vector<Point>(all.begin() + static_cast<std::ptrdiff_t>(first),
                                all.begin() + static_cast<std::ptrdiff_t>(end));
    };
    const std::vector<Point> normals = normals_along_walls(slice(scan.points), slice(scan.normals));
    std::copy(normals.begin(), normals.end(),
              tracked.matched.normals.begin() + static_cast<std::ptrdiff_t>(first));
  });
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    if (is_set(scan.normals[i]) || !is_set(tracked.matched.normals[i]))
      tracked.judged.points.push_back(scan.points[i]);
  return tracked;
}

}  // namespace psi_slam
