// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/tracked_points.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapping/local_maps/grazed_wall.h"
#include "mapping/local_maps/surface_normals.h"

namespace psi_slam {
namespace {

using Point = mrpt::math::TPoint2Df;

bool is_set(const Point& normal) {
  return normal.x != 0.0F || normal.y != 0.0F;
}

std::optional<GrazedWall> wall_from(const Point* points) {
  std::array<mrpt::math::TPoint2D, kWallEnds> ends;
  for (std::size_t k = 0; k < kWallEnds; ++k)
    ends[k] = {static_cast<double>(points[k].x), static_cast<double>(points[k].y)};
  return grazed_wall(ends);
}

/// Normals of the points of one laser. A point without a normal gets that of the straightest wall through it.
std::vector<Point> normals_along_walls(const std::vector<Point>& points, const std::vector<Point>& normals) {
  std::vector<std::optional<GrazedWall>> walls;  // by their first point
  for (std::size_t i = 0; i + kWallEnds <= points.size(); ++i) walls.push_back(wall_from(&points[i]));
  std::vector<Point> result = normals_of_neighbours(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_set(normals[i])) continue;
    const GrazedWall* straightest = nullptr;
    for (std::size_t k = i < kWallEnds ? 0 : i - (kWallEnds - 1); k <= i && k < walls.size(); ++k)
      if (walls[k] && (straightest == nullptr || walls[k]->offset_m < straightest->offset_m))
        straightest = &*walls[k];
    result[i] = straightest == nullptr ? Point(0, 0)
                                       : Point(static_cast<float>(straightest->normal.x),
                                               static_cast<float>(straightest->normal.y));
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
