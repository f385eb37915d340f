// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/map_views.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "logs/frames/discarded_ranges.h"
#include "logs/frames/pose_operations.h"
#include "map/verdict/open_directions.h"
#include "mapping/local_maps/scan_filter.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kSpacing_m = 0.05;  // between the points of a view

bool are_monotone(const std::vector<float>& bearings_rad) {
  const auto begin = bearings_rad.begin();
  const auto end = bearings_rad.end();
  return std::adjacent_find(begin, end, std::greater_equal<>()) == end ||
         std::adjacent_find(begin, end, std::less_equal<>()) == end;
}

SurfacePoints evenly_chosen(const SurfacePoints& all, std::size_t most) {
  const std::size_t count = std::min(all.points.size(), most);
  SurfacePoints chosen;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = i * all.points.size() / count;
    chosen.points.push_back(all.points[index]);
    chosen.normals.push_back(all.normals[index]);
  }
  return chosen;
}

}  // namespace

std::optional<MapView> view_of_frame(const MappingResult& result, std::size_t frame,
                                     const MapViewOptions& options) {
  const Frame& scanned = result.log[frame];
  if (!has_ranges(scanned) || !scanned.scan.bearings_rad || scanned.scan.ranges_m.size() < 2 ||
      !are_monotone(*scanned.scan.bearings_rad))
    return std::nullopt;
  ScanFilterOptions filter;
  filter.spacing_m = kSpacing_m;
  MapView view;
  view.node = result.frames[frame].node.value_or(0);
  view.frame = frame;
  view.map_T_robot = result.frames[frame].map_T_robot;
  view.scan = &scanned.scan;
  const auto chosen_surfaces = [&](const auto& seen) {
    return evenly_chosen(surface_points(matching_points(seen, filter)), options.max_points);
  };
  view.surfaces = chosen_surfaces(scanned.scan);
  view.open_direction = open_direction(scanned.companions.empty() ? view.surfaces : chosen_surfaces(scanned));
  return view;
}

std::vector<MapView> map_views(const MappingResult& result, const MapViewOptions& options) {
  const std::vector<FrameSpan> runs = runs_of(result);
  std::vector<MapView> views;
  std::size_t run = 0;
  double travelled_m = 0;
  const TPose2D* before = nullptr;
  for (std::size_t node = 0; node < result.node_frames.size(); ++node) {
    const std::size_t frame = result.node_frames[node];
    const TPose2D& here = result.frames[frame].map_T_robot;
    if (frame >= runs[run].end) {
      while (frame >= runs[run].end) ++run;
      travelled_m = 0;
      before = nullptr;
    }
    if (before != nullptr) travelled_m += distance_m(*before, here);
    before = &here;
    const MapView* last = views.empty() || views.back().run != run ? nullptr : &views.back();
    if (last != nullptr && travelled_m - last->travelled_m < options.step_m &&
        std::abs(mrpt::math::wrapToPi(here.phi - last->map_T_robot.phi)) < options.turn_rad)
      continue;
    std::optional<MapView> view = view_of_frame(result, frame, options);
    if (!view) continue;
    view->node = node;
    view->run = run;
    view->travelled_m = travelled_m;
    views.push_back(*std::move(view));
  }
  return views;
}

bool are_different_passes(const MapView& a, const MapView& b, double apart_m) {
  return a.run != b.run || std::abs(a.travelled_m - b.travelled_m) > apart_m;
}

}  // namespace psi_slam
