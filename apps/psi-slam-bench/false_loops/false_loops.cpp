// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/false_loops.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/random_draws.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct Material {
  std::vector<std::size_t> anchors;
  std::vector<Constraint> loops;  ///< enabled ones
};

Material material_of(const PoseGraph& graph) {
  Material material;
  std::set<std::size_t> anchors;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    const Constraint& constraint = graph.constraint(i);
    if (constraint.kind == Constraint::Kind::kLocalMap) anchors.insert(constraint.from);
    if (constraint.kind != Constraint::Kind::kLoop || !graph.enabled(i)) continue;
    anchors.insert(constraint.from);
    material.loops.push_back(constraint);
  }
  material.anchors.assign(anchors.begin(), anchors.end());
  return material;
}

TPose2D draw_place(double reach_m, RandomDraws& draws) {
  const double radius_m = reach_m * std::sqrt(draws.share());
  const double direction = draws.plus_minus(M_PI);
  return {radius_m * std::cos(direction), radius_m * std::sin(direction), draws.plus_minus(M_PI)};
}

bool is_false(const TPose2D& place, const TPose2D& truth, const FalseLoopOptions& options) {
  TPose2D error = place - truth;
  error.normalizePhi();
  return std::hypot(error.x, error.y) >= options.min_error_m || std::abs(error.phi) >= options.min_error_rad;
}

/// One node, or several successive nodes, at one wrong place.
std::vector<Constraint> draw_elsewhere(const Material& material, const std::vector<TPose2D>& map_T_node,
                                       const FalseLoopOptions& options, RandomDraws& draws) {
  std::size_t group = 1;
  if (options.kind == FalseLoopKind::kGroups)
    group = options.smallest_group + draws.index(options.largest_group - options.smallest_group + 1);
  const std::size_t first = draws.index(map_T_node.size());
  const std::size_t last = std::min(first + group, map_T_node.size());
  const std::size_t anchor = material.anchors[draws.index(material.anchors.size())];
  const TPose2D place = draw_place(options.reach_m, draws);
  std::vector<Constraint> loops;
  for (std::size_t node = first; node < last; ++node) {
    Constraint loop;
    loop.from = anchor;
    loop.to = node;
    loop.from_T_to = place + (map_T_node[node] - map_T_node[first]);
    loop.information = material.loops[draws.index(material.loops.size())].information;
    loops.push_back(loop);
  }
  return loops;
}

Constraint draw_nearby(const Material& material, const FalseLoopOptions& options, RandomDraws& draws) {
  Constraint loop = material.loops[draws.index(material.loops.size())];
  const double off_m = options.min_error_m + draws.share() * (options.nearby_m - options.min_error_m);
  const double direction = draws.plus_minus(M_PI);
  loop.from_T_to = loop.from_T_to + TPose2D(off_m * std::cos(direction), off_m * std::sin(direction),
                                            draws.plus_minus(options.min_error_rad));
  return loop;
}

}  // namespace

std::string name_of(FalseLoopKind kind) {
  switch (kind) {
    case FalseLoopKind::kScattered:
      return "scattered";
    case FalseLoopKind::kGroups:
      return "groups";
    case FalseLoopKind::kNearby:
      break;
  }
  return "nearby";
}

std::vector<std::size_t> add_false_loops(PoseGraph& graph, const std::vector<TPose2D>& map_T_node,
                                         const FalseLoopOptions& options) {
  const Material material = material_of(graph);
  std::vector<std::size_t> added;
  if (material.loops.empty()) return added;
  RandomDraws draws(options.seed, name_of(options.kind), 0);
  while (added.size() < options.count) {
    std::vector<Constraint> loops = options.kind == FalseLoopKind::kNearby
                                        ? std::vector<Constraint>{draw_nearby(material, options, draws)}
                                        : draw_elsewhere(material, map_T_node, options, draws);
    for (Constraint& loop : loops) {
      loop.from_T_to.normalizePhi();
      loop.kind = Constraint::Kind::kLoop;
      const bool wrong = loop.from != loop.to &&
                         is_false(loop.from_T_to, map_T_node[loop.to] - map_T_node[loop.from], options);
      if (wrong && added.size() < options.count) added.push_back(graph.add_constraint(loop));
    }
  }
  return added;
}

}  // namespace psi_slam
