// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/grazed_wall.h"

#include <algorithm>
#include <cmath>

#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;

constexpr double kMaxWallOffset_m = 0.04;
constexpr double kMaxGapRatio = 16;

}  // namespace

std::optional<GrazedWall> grazed_wall(const std::array<TPoint2D, kWallEnds>& ends) {
  std::array<double, kWallEnds - 1> gaps_m{};
  for (std::size_t k = 0; k < gaps_m.size(); ++k) gaps_m[k] = distance_m(ends[k], ends[k + 1]);
  const auto [narrowest, widest] = std::minmax_element(gaps_m.begin(), gaps_m.end());
  const double length = distance_m(ends.front(), ends.back());
  if (*narrowest <= 0 || *widest > kMaxGapRatio * *narrowest || length < *widest) return {};
  GrazedWall wall;
  wall.normal = {(ends.front().y - ends.back().y) / length, (ends.back().x - ends.front().x) / length};
  for (std::size_t k = 1; k + 1 < kWallEnds; ++k)
    wall.offset_m = std::max(wall.offset_m, std::abs(wall.normal.x * (ends[k].x - ends.front().x) +
                                                     wall.normal.y * (ends[k].y - ends.front().y)));
  if (wall.offset_m > kMaxWallOffset_m) return {};
  return wall;
}

}  // namespace psi_slam
