// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/last_pass.h"

#include <cmath>
#include <limits>

#include "loop_attempt.h"

namespace psi_slam {
namespace {

bool is_near(std::size_t node, const PlacedLocalMap& local_map, const PoseGraph& graph, double reach_m) {
  const mrpt::math::TPose2D& here = graph.pose(node);
  for (std::size_t other = local_map.first_node; other <= local_map.last_node; ++other) {
    const mrpt::math::TPose2D& there = graph.pose(other);
    if (std::hypot(there.x - here.x, there.y - here.y) <= reach_m) return true;
  }
  return false;
}

}  // namespace

std::vector<LoopRecord> last_pass(const PlaceMemory& memory, const PoseGraph& graph, const Matcher& matcher,
                                  const LoopVerificationOptions& verification, const LastPassOptions& options,
                                  const std::function<bool(std::size_t, std::size_t)>& known,
                                  const std::function<bool(double)>& progress) {
  std::vector<LoopRecord> loops;
  for (std::size_t m = 0; m < memory.local_maps.size(); ++m) {
    const PlacedLocalMap& local_map = memory.local_maps[m];
    double last_m = -std::numeric_limits<double>::infinity();
    for (std::size_t node = 0; node < memory.nodes.size(); ++node) {
      if (node >= local_map.first_node && node <= local_map.last_node) continue;
      const double here_m = memory.nodes[node].travelled_m;
      if (here_m - last_m < options.travel_m || !is_near(node, local_map, graph, options.reach_m)) continue;
      last_m = here_m;
      if (known(node, m)) continue;
      LoopCandidate candidate;
      candidate.local_map = m;
      candidate.anchor_T_node = graph.pose(node) - graph.pose(local_map.anchor);
      candidate.extent = {options.window_m, options.window_m, options.window_rad};
      if (auto loop =
              attempt_loop(node, *memory.nodes[node].points, candidate, memory, matcher, verification)) {
        loop->in_last_pass = true;
        loops.push_back(std::move(*loop));
      }
    }
    if (!progress(static_cast<double>(m + 1) / static_cast<double>(memory.local_maps.size()))) break;
  }
  return loops;
}

}  // namespace psi_slam
