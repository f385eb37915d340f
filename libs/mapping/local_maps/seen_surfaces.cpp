// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/seen_surfaces.h"

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "logs/frames/beam_directions.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/scan_neighbours.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;

constexpr double kMinGap_m = 0.05;  // smaller gaps leave no cell to draw
constexpr double kMaxGap_m = 2.0;   // largest distance between joined ends
constexpr double kMaxGapPerSpacing =
    5;  // largest ratio of end distance to beam spacing; excludes grazing beams
constexpr double kMaxOffset_m = 0.06;      // largest distance of a third end from the line through two ends
constexpr double kMaxOffsetPerGap = 0.15;  // the same limit as a share of the gap; the larger limit applies

bool in_line(const TPoint2D& a, const TPoint2D& b, const TPoint2D& third) {
  const double gap = distance_m(a, b);
  const double offset = std::abs((third.x - b.x) * (b.y - a.y) - (third.y - b.y) * (b.x - a.x)) / gap;
  return offset <= std::max(kMaxOffset_m, kMaxOffsetPerGap * gap);
}

}  // namespace

std::vector<bool> ends_on_one_surface(const LaserScan& scan, double max_range_m, double min_spacing_m) {
  const std::size_t beams = scan.ranges_m.size();
  const auto range = [&](std::size_t i) { return static_cast<double>(scan.ranges_m[i]); };
  const auto bearing = [&](std::size_t i) { return static_cast<double>((*scan.bearings_rad)[i]); };
  std::vector<TPoint2D> ends;
  ends.reserve(beams);
  const BeamDirections directions = beam_directions(scan.bearings_rad);
  for (std::size_t i = 0; i < beams; ++i) ends.push_back((*directions)[i] * range(i));

  // Indices of the neighbours of a beam; `beams` for a missing one.
  const bool is_ring = beams > 0 && is_full_circle(*scan.bearings_rad);
  const auto before = [&](std::size_t i) { return i > 0 ? i - 1 : is_ring ? beams - 1 : beams; };
  const auto after = [&](std::size_t i) { return i + 1 == beams && is_ring ? 0 : i + 1; };

  // False for beams without a return, whose range is infinite or NaN.
  const auto hit = [&](std::size_t i) { return i < beams && range(i) <= max_range_m; };
  std::vector<bool> joined(beams, false);
  for (std::size_t i = 0; i < beams; ++i) {
    const std::size_t last = before(i);
    if (!hit(last) || !hit(i)) continue;
    const double gap = distance_m(ends[last], ends[i]);
    const double turn_rad = std::remainder(bearing(i) - bearing(last), 2 * M_PI);
    const double spacing = std::abs(turn_rad) * std::min(range(last), range(i));
    if (spacing < min_spacing_m || gap < kMinGap_m || gap > kMaxGap_m || gap > kMaxGapPerSpacing * spacing)
      continue;
    const auto continues_to = [&](std::size_t third) {
      return hit(third) && in_line(ends[last], ends[i], ends[third]);
    };
    joined[i] = continues_to(before(last)) || continues_to(after(i));
  }
  return joined;
}

}  // namespace psi_slam
