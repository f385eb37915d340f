// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_snapshot.h"

namespace psi_slam {
namespace {

/// The last node whose scan is `frame` or an earlier one.
std::size_t last_node_up_to(const HistoryView<NodeScan>& nodes, std::size_t frame) {
  std::size_t begin = 0;
  std::size_t end = nodes.size();
  while (end - begin > 1) {
    const std::size_t middle = begin + (end - begin) / 2;
    (nodes[middle].frame <= frame ? begin : end) = middle;
  }
  return begin;
}

}  // namespace

mrpt::math::TPose2D map_T_frame(const ReplaySnapshot& snapshot, std::size_t frame) {
  const bool finished = snapshot.phase == ReplayPhase::kFinished || snapshot.phase == ReplayPhase::kExporting;
  if (finished || snapshot.nodes.empty()) return snapshot.frames[frame].map_T_robot;
  const std::size_t node = last_node_up_to(snapshot.nodes, frame);
  const mrpt::math::TPose2D node_T_frame =
      snapshot.frames[frame].front_end_T_robot - snapshot.nodes[node].local_T_robot;
  return (*snapshot.map_T_node)[node] + node_T_frame;
}

}  // namespace psi_slam
