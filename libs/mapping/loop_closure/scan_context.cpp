// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/scan_context.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

// Returns a number that identifies the square of side `size_m` around a point.
std::int64_t square_of(float x, float y, double size_m) {
  const auto column = static_cast<std::int64_t>(std::floor(static_cast<double>(x) / size_m));
  const auto row = static_cast<std::int64_t>(std::floor(static_cast<double>(y) / size_m));
  return row * (std::int64_t{1} << 32) + column;
}

// Keeps `count` of more elements, at equal distances.
template <class Element>
void thin(std::vector<Element>& elements, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) elements[i] = elements[i * elements.size() / count];
  elements.resize(count);
}

}  // namespace

ScanPoints scan_context(std::size_t node, const KeyframeStore& keyframes, const ScanContextOptions& options) {
  const NodeScan& here = keyframes.nodes[node];
  ScanPoints context;
  context.origin = here.points->origin;
  std::unordered_set<std::int64_t> taken;
  const auto add = [&](const NodeScan& there) {
    const mrpt::math::TPose2D here_T_there = between(here.local_T_robot, there.local_T_robot);
    const auto c = static_cast<float>(portable::cos(here_T_there.phi));
    const auto s = static_cast<float>(portable::sin(here_T_there.phi));
    const auto x0 = static_cast<float>(here_T_there.x);
    const auto y0 = static_cast<float>(here_T_there.y);
    for (std::size_t i = 0; i < there.points->points.size(); ++i) {
      const auto& point = there.points->points[i];
      const auto normal =
          there.points->normals.empty() ? mrpt::math::TPoint2Df(0, 0) : there.points->normals[i];
      const float x = x0 + c * point.x - s * point.y;
      const float y = y0 + s * point.x + c * point.y;
      if (!taken.insert(square_of(x, y, options.point_spacing_m)).second) continue;
      context.points.emplace_back(x, y);
      context.normals.emplace_back(c * normal.x - s * normal.y, s * normal.x + c * normal.y);
    }
  };
  add(here);
  double last_m = here.travelled_m;
  for (std::size_t before = node; before-- > 0;) {
    const NodeScan& there = keyframes.nodes[before];
    if (here.travelled_m - there.travelled_m > options.travel_m) break;
    if (!there.points || last_m - there.travelled_m < options.node_spacing_m) continue;
    last_m = there.travelled_m;
    add(there);
  }
  const auto most = static_cast<std::size_t>(options.max_points);
  if (context.points.size() > most) {
    thin(context.points, most);
    thin(context.normals, most);
  }
  for (const auto& point : context.points)
    context.farthest_m = std::max(context.farthest_m, portable::hypot(double{point.x}, double{point.y}));
  return context;
}

}  // namespace psi_slam
