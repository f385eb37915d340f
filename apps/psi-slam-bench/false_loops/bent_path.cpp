// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/bent_path.h"

#include <cmath>

#include "base/random_draws.h"
#include "logs/frames/pose_operations.h"
#include "pose_graph/changed_path.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Change of each motion of one stretch.
struct Bend {
  double scale = 1;
  double turn_rad = 0;  ///< added to each motion
};

// Chooses the stretches that bend.
std::vector<bool> draw_stretches(std::size_t nodes, const BentPathOptions& options, RandomDraws& draws) {
  const std::size_t motions = nodes == 0 ? 0 : nodes - 1;
  const std::size_t count = (motions + options.stretch_nodes - 1) / options.stretch_nodes;
  const auto chosen = static_cast<std::size_t>(std::lround(options.share * static_cast<double>(count)));
  std::vector<bool> slips(count);
  for (std::size_t left = chosen; left > 0;) {
    const std::size_t stretch = draws.index(count);
    if (slips[stretch]) continue;
    slips[stretch] = true;
    --left;
  }
  return slips;
}

Bend draw_bend(const BentPathOptions& options, std::size_t bent_before, RandomDraws& draws) {
  const double sign = draws.share() < 0.5 ? -1 : 1;
  if (bent_before % 2 == 0) return {1 + sign * options.stretching, 0};
  return {1, sign * options.turn_rad / static_cast<double>(options.stretch_nodes)};
}

}  // namespace

BentPath bent(const PoseGraph& graph, const std::vector<TPose2D>& unlooped, const BentPathOptions& options) {
  RandomDraws draws(options.seed, "slips", 0);
  const std::vector<bool> slips = draw_stretches(unlooped.size(), options, draws);
  BentPath result;
  if (!unlooped.empty()) result.unlooped.push_back(unlooped.front());
  Bend bend;
  for (std::size_t node = 1; node < unlooped.size(); ++node) {
    if ((node - 1) % options.stretch_nodes == 0) {
      const bool bends = slips[(node - 1) / options.stretch_nodes];
      bend = bends ? draw_bend(options, result.stretches, draws) : Bend{};
      result.stretches += bends ? 1 : 0;
    }
    const TPose2D motion = between(unlooped[node - 1], unlooped[node]);
    result.unlooped.push_back(
        compose(result.unlooped.back(),
                TPose2D(bend.scale * motion.x, bend.scale * motion.y, motion.phi + bend.turn_rad)));
    result.unlooped.back().normalizePhi();
  }

  result.graph = with_changed_path(graph, [&](Constraint& constraint) {
    const auto motion = [&](const std::vector<TPose2D>& path) {
      return between(path[constraint.from], path[constraint.to]);
    };
    constraint.from_T_to = compose(constraint.from_T_to, between(motion(unlooped), motion(result.unlooped)));
    constraint.from_T_to.normalizePhi();
  });
  return result;
}

}  // namespace psi_slam
