// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/keyframe_store.h"

#include <cmath>
#include <utility>

namespace psi_slam {
namespace {

constexpr std::size_t kUnpackedLocalMaps = 48;

}  // namespace

KeyframeStore make_keyframe_store() {
  KeyframeStore memory;
  memory.cache = std::make_shared<LocalMapCache>(kUnpackedLocalMaps);
  return memory;
}

void remember_node(const FrontEndStep& step, std::size_t frame, KeyframeStore& memory) {
  NodeScan node;
  node.frame = frame;
  node.local_T_robot = step.local_T_robot;
  node.points = step.points;
  if (!memory.nodes.empty()) {
    const mrpt::math::TPose2D motion = step.local_T_robot - memory.nodes.back().local_T_robot;
    node.travelled_m = memory.nodes.back().travelled_m + std::hypot(motion.x, motion.y);
  }
  memory.nodes.push_back(std::move(node));
}

void remember_local_map(const PlacedLocalMap& finished, KeyframeStore& memory) {
  memory.local_maps.push_back(finished);
  if (memory.cache) memory.cache->add(finished.map);
}

void unpack_local_maps(const KeyframeStore& memory, const std::vector<std::size_t>& local_maps, WorkerPool& pool) {
  if (memory.cache) memory.cache->use(local_maps, pool);
}

bool begins_stretch(std::size_t node, const std::vector<NodeScan>& nodes, double stretch_m) {
  if (node == 0 || stretch_m <= 0) return true;
  const auto stretch = [&](std::size_t i) { return std::floor(nodes[i].travelled_m / stretch_m); };
  return stretch(node) != stretch(node - 1);
}

}  // namespace psi_slam
