// SPDX-License-Identifier: BSD-3-Clause
#include "match/loop_cases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/portable_math.h"
#include "base/random_draws.h"
#include "logs/frames/pose_operations.h"
#include "mapping/loop_closure/scan_context.h"
#include "psi_slam/open_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Length of the path in metres between a node and a local map; 0 for nodes of the local map.
double travel_between_m(const KeyframeStore& memory, std::size_t node, const PlacedLocalMap& map) {
  const double here_m = memory.nodes[node].travelled_m;
  return std::max({0.0, here_m - memory.nodes[map.last_node].travelled_m,
                   memory.nodes[map.first_node].travelled_m - here_m});
}

double nearest_node_m(const MappedLog& log, std::size_t node, const PlacedLocalMap& map) {
  const TPose2D& here = log.map_T_node[node];
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t other = map.first_node; other <= map.last_node; ++other) {
    const double dx = log.map_T_node[other].x - here.x;
    const double dy = log.map_T_node[other].y - here.y;
    nearest = std::min(nearest, dx * dx + dy * dy);
  }
  return std::sqrt(nearest);
}

/// All pairs of a node and a local map that suit positive or negative cases, ordered by local map, then node.
std::vector<std::pair<std::size_t, std::size_t>> pairs(const MappedLog& log, const CaseOptions& options,
                                                       bool positive) {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  for (std::size_t m = 0; m < log.memory.local_maps.size(); ++m) {
    const PlacedLocalMap& map = log.memory.local_maps[m];
    for (std::size_t node = 0; node < log.memory.nodes.size(); ++node) {
      if (travel_between_m(log.memory, node, map) < options.min_travel_m) continue;
      const double nearest_m = nearest_node_m(log, node, map);
      if (positive ? nearest_m <= options.near_m : nearest_m > options.window_m + options.clear_m)
        result.emplace_back(node, m);
    }
  }
  return result;
}

bool can_be_searched(const ScanPoints& scan, const LocalMap& map, const CaseOptions& options) {
  return scan.points.size() >= options.min_points && scan.farthest_m > map.scores().resolution_m();
}

bool shares_space(const LoopCase& loop_case, const CaseOptions& options) {
  const LocalMap::Agreement agreement = loop_case.map->agreement(*loop_case.scan, loop_case.anchor_T_node);
  const auto points = static_cast<double>(loop_case.scan->points.size());
  return static_cast<double>(agreement.observed) >= options.min_observed_share * points &&
         agreement.share() >= options.min_hit_share;
}

TPose2D draw_start(const MappedLog& log, const LoopCase& loop_case, const CaseOptions& options,
                   RandomDraws& draws) {
  const PlacedLocalMap& map = log.memory.local_maps[loop_case.local_map];
  TPose2D start = loop_case.anchor_T_node;
  if (!loop_case.positive) {
    const std::size_t other = map.first_node + draws.index(map.last_node - map.first_node + 1);
    start = between(log.map_T_node[map.anchor], log.map_T_node[other]);
    start.phi = draws.plus_minus(M_PI);
  }
  const double radius_m = options.start_share * options.window_m * std::sqrt(draws.share());
  const double direction = draws.plus_minus(M_PI);
  start.x += radius_m * portable::cos(direction);
  start.y += radius_m * portable::sin(direction);
  start.phi += draws.plus_minus(options.turn_share * options.window_rad);
  start.normalizePhi();
  return start;
}

void draw(const MappedLog& log, const CaseOptions& options, bool positive, std::vector<LoopCase>& cases) {
  RandomDraws draws(options.seed, log.name, positive ? 1U : 0U);
  auto left = pairs(log, options, positive);
  std::size_t drawn = 0;
  while (drawn < options.count && !left.empty()) {
    std::swap(left[draws.index(left.size())], left.back());
    const auto [node, local_map] = left.back();
    left.pop_back();
    const PlacedLocalMap& map = log.memory.local_maps[local_map];
    LoopCase loop_case;
    loop_case.positive = positive;
    loop_case.node = node;
    loop_case.local_map = local_map;
    loop_case.map = map.map;
    loop_case.scan = options.context ? std::make_shared<const ScanPoints>(scan_context(
                                           node, log.memory, log.options.back_end.loop_closure.context))
                                     : log.memory.nodes[node].points;
    loop_case.anchor_T_node = between(log.map_T_node[map.anchor], log.map_T_node[node]);
    loop_case.seed = {options.seed, log.memory.nodes[node].frame, map.id};
    if (!can_be_searched(*loop_case.scan, *loop_case.map, options)) continue;
    if (positive && !shares_space(loop_case, options)) continue;
    loop_case.start = draw_start(log, loop_case, options, draws);
    cases.push_back(std::move(loop_case));
    ++drawn;
  }
}

}  // namespace

MappedLog map_log(const BenchmarkLog& log, const std::function<void(double)>& progress) {
  const Settings settings = benchmark_settings(log.ini);
  MappedLog mapped;
  mapped.name = log.name;
  mapped.options = settings.mapper;
  const std::unique_ptr<FrameSource> source = open_log(log.log, log_options(settings));
  Mapper mapper(mapped.options);
  // A second front end repeats the work of the mapper, whose local maps are not accessible.
  FrontEnd places(mapped.options.front_end);
  const auto keep = [&mapped](const std::vector<PlacedLocalMap>& finished) {
    for (const PlacedLocalMap& local_map : finished) remember_local_map(local_map, mapped.memory);
  };
  for (std::size_t frames = 0; std::optional<Frame> frame = source->next(); ++frames) {
    const FrontEndStep step = places.add(*frame);
    if (step.node) remember_node(step, frames, mapped.memory);
    keep(step.finished);
    mapper.add(std::move(*frame));
    progress(source->progress());
  }
  keep(places.finish());
  const MappingResult result = mapper.finish();
  mapped.map_T_node = result.graph.poses();
  mapped.translation_error_m =
      error_of(result.frames, read_relations(log.relations.value())).translation_abs_m.mean;
  return mapped;
}

std::vector<LoopCase> draw_cases(const MappedLog& log, const CaseOptions& options) {
  std::vector<LoopCase> cases;
  draw(log, options, true, cases);
  draw(log, options, false, cases);
  return cases;
}

}  // namespace psi_slam
